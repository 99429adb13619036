#include "report/text.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <vector>

#include "types/plain_number.hpp"

namespace tissue_stiffness {
namespace {

/// Returns the position of the leading digit: 0 for 1 to 9.99.
int magnitude(double value) {
  return static_cast<int>(std::floor(std::log10(std::abs(value))));
}

/// The symbol that a unit begins with, and its power: {"m", 3} of "m^3/N". It is empty when it takes no prefix.
struct LeadingSymbol {
  std::string symbol;
  int power = 1;
};

LeadingSymbol leading_symbol(const std::string& unit) {
  static const std::regex pattern(R"((Pa|N|m|s|rad)(?:\^(\d))?(?=$|[/ ]))");
  std::smatch found;
  if (!std::regex_search(unit, found, pattern, std::regex_constants::match_continuous)) return {};
  return {found.str(1), found[2].matched ? std::stoi(found.str(2)) : 1};
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

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string exact_number(double value) {
  return std::isfinite(value) ? nlohmann::json(value).dump() : "";
}

std::string short_number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  if (value == 0.0) return "0";
  const int order = leading_place(value, digits);
  if (order >= -4 && order < 6) return with_decimals(value, std::max(0, digits - 1 - order));
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << std::setprecision(digits) << value;
  return stream.str();
}

std::string millimetres(double metres) {
  return std::isfinite(metres) ? short_number(1e3 * metres, 3) + " mm" : "-";
}

std::string percentage(double share, int digits) {
  if (!std::isfinite(share)) return "-";
  if (share < 1e-3) return "< 0.1 %";
  if (share > 0.999 && share < 1.0) return "> 99.9 %";
  return short_number(100.0 * share, digits) + " %";
}

std::string test_statistic(double z) {
  return z > 100.0 ? "> 100" : short_number(z, 2);
}

ShownUnit shown_unit(double value, const std::string& unit) {
  static const std::vector<std::pair<double, std::string>> prefixes = {{1e9, "G"},  {1e6, "M"},  {1e3, "k"}, {1.0, ""},
                                                                       {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}};
  if (unit == "kg" && std::abs(value) < 1.0 && value != 0.0) {
    return std::abs(value) < 1e-3 ? ShownUnit{1e6, "mg"} : ShownUnit{1e3, "g"};
  }
  if (unit == "-" && std::abs(value) < 1e-3 && value != 0.0) return {100.0, "%"};
  const LeadingSymbol leading = leading_symbol(unit);
  if (leading.symbol.empty() || !std::isfinite(value) || value == 0.0) return {1.0, unit == "-" ? "" : unit};
  const bool grows = leading.symbol == "Pa" || leading.symbol == "N";  // nobody writes km, ks or krad
  const double from = grows || leading.power > 1 ? 1.0 : 0.1;          // 0.3 mm rather than 300 µm
  for (const auto& [prefix_size, prefix] : prefixes) {
    const double size = std::pow(prefix_size, leading.power);
    if (!grows && size > 1.0) continue;
    if (std::abs(value) >= from * size || prefix == "n") return {1.0 / size, prefix + unit};
  }
  return {1.0, unit};
}

std::string with_unit(double value, const std::string& unit, int digits) {
  if (!std::isfinite(value)) return "-";
  const ShownUnit shown = shown_unit(value, unit);
  return short_number(shown.scale * value, digits) + (shown.name.empty() ? "" : " " + shown.name);
}

std::string rounded(double value, double uncertainty) {
  if (!std::isfinite(value) || !std::isfinite(uncertainty) || !(uncertainty > 0.0)) return short_number(value, 4);
  const int decimals = 1 - magnitude(uncertainty);
  if (decimals > 8 || decimals < -5) return short_number(value, 4);
  if (decimals >= 0) return with_decimals(value, decimals);
  const double step = std::pow(10.0, -decimals);
  return with_decimals(std::round(value / step) * step, 0);
}

ShownEstimate shown_estimate(const ParameterEstimate& p, double scale) {
  const double half_width = 0.5 * scale * (p.upper95 - p.lower95);
  const auto show = [&](double value) { return rounded(scale * value, half_width); };
  return {show(p.mean), show(p.lower95), show(p.upper95)};
}

std::string shown_moduli(const std::map<std::string, double>& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) {
    if (is_young_modulus(name)) text += (text.empty() ? "" : ", ") + with_unit(value, "Pa", 4);
  }
  return text;
}

}  // namespace tissue_stiffness
