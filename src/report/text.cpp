#include "report/text.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

namespace tissue_stiffness {
namespace {

std::string fixed(double value, int decimals) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << std::fixed << std::setprecision(decimals) << value;
  return stream.str();
}

/// Returns the position of the leading digit: 0 for 1 to 9.99.
int magnitude(double value) {
  return static_cast<int>(std::floor(std::log10(std::abs(value))));
}

}  // namespace

std::string escape_html(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 32 || c == '\n' || c == '\t') escaped += c;
    }
  }
  return escaped;
}

std::string exact_number(double value) {
  return std::isfinite(value) ? nlohmann::json(value).dump() : "";
}

std::string short_number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  if (value == 0.0) return "0";
  const int order = magnitude(value);
  if (order >= -4 && order < 6) return fixed(value, std::max(0, digits - 1 - order));
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << std::setprecision(digits) << value;
  return stream.str();
}

std::string fixed_number(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  const std::string text = fixed(value, decimals);
  return text.find_first_of("123456789") == std::string::npos ? fixed(0.0, decimals) : text;
}

std::string millimetres(double metres) {
  return std::isfinite(metres) ? short_number(1e3 * metres, 3) + " mm" : "-";
}

ShownUnit shown_unit(double value, const std::string& unit) {
  static const std::vector<std::string> scaled = {"Pa", "N", "m", "s"};
  static const std::vector<std::pair<double, std::string>> prefixes = {{1e9, "G"}, {1e6, "M"},  {1e3, "k"},
                                                                       {1.0, ""},  {1e-3, "m"}, {1e-6, "µ"}};
  const bool scales = std::find(scaled.begin(), scaled.end(), unit) != scaled.end();
  if (!scales || !std::isfinite(value) || value == 0.0) return {1.0, unit == "-" ? "" : unit};
  const bool length_or_time = unit == "m" || unit == "s";  // 0.3 mm rather than 300 µm; nobody writes km or ks
  const double from = length_or_time ? 0.1 : 1.0;
  for (const auto& [size, prefix] : prefixes) {
    if (length_or_time && size > 1.0) continue;
    if (std::abs(value) >= from * size) return {1.0 / size, prefix + unit};
  }
  return {1e6, "µ" + unit};
}

std::string rounded(double value, double uncertainty) {
  if (!std::isfinite(value) || !std::isfinite(uncertainty) || !(uncertainty > 0.0)) return short_number(value, 4);
  const int decimals = 1 - magnitude(uncertainty);
  if (decimals > 8 || decimals < -5) return short_number(value, 4);
  if (decimals >= 0) return fixed(value, decimals);
  const double step = std::pow(10.0, -decimals);
  return fixed(std::round(value / step) * step, 0);
}

}  // namespace tissue_stiffness
