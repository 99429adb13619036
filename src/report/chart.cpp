#include "tissue_stiffness/report/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue_stiffness/report/text.hpp"

namespace tissue_stiffness {
namespace {

constexpr double view = 1000.0;  // the SVG's own coordinates; CSS stretches them

/// Maps a quantity to 0..1 on its axis.
struct Axis {
  double low = 0.0, high = 1.0;
  bool logarithmic = false;

  double operator()(double value) const {
    if (!logarithmic) return (value - low) / (high - low);
    return value > 0.0 ? std::log(value / low) / std::log(high / low) : -1.0;
  }
  std::vector<double> ticks(int count) const {
    if (!logarithmic) return linear_ticks(low, high, count);
    const std::vector<double> decades = log_ticks(low, high);
    return decades.size() < 2 ? linear_ticks(low, high, count) : decades;
  }
};

void stretch(const std::vector<double>& values, double& low, double& high) {
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
}

Axis value_axis(const Chart& chart) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  stretch(chart.line, low, high);
  stretch(chart.lower, low, high);
  stretch(chart.upper, low, high);
  if (!chart.reference_name.empty()) stretch({chart.reference}, low, high);
  if (!(low <= high)) return {};
  if (chart.from_zero) low = std::min(low, 0.0);
  if (low > 0.0 && high > 8.0 * low) return {low / 1.1, high * 1.1, true};
  const double margin = high > low ? 0.05 * (high - low) : std::max(0.05 * std::abs(high), 1e-12);
  return {chart.from_zero && low == 0.0 ? 0.0 : low - margin, high + margin, false};
}

Axis time_axis(const Chart& chart) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  stretch(chart.time, low, high);
  stretch(chart.skipped, low, high);
  if (!(low <= high)) return {};
  return high > low ? Axis{low, high, false} : Axis{low - 0.5, high + 0.5, false};
}

/// Coordinates far outside the picture would overflow some renderers.
std::string coordinate(double position) {
  return exact_number(std::round(10.0 * view * std::clamp(position, -5.0, 5.0)) / 10.0);
}

std::string point(const Axis& x, const Axis& y, double time, double value) {
  return coordinate(x(time)) + " " + coordinate(1.0 - y(value));
}

/// Polyline with a gap at every value that is not finite.
std::string line_path(const Chart& chart, const Axis& x, const Axis& y) {
  std::string path;
  bool down = false;
  for (std::size_t i = 0; i < chart.line.size(); ++i) {
    const bool finite = std::isfinite(chart.line[i]);
    if (finite) path += (down ? "L" : "M") + point(x, y, chart.time[i], chart.line[i]);
    down = finite;
  }
  return path;
}

/// One polygon a run of finite values.
std::string band_path(const Chart& chart, const Axis& x, const Axis& y) {
  std::string path, back;
  for (std::size_t i = 0; i < chart.lower.size(); ++i) {
    if (std::isfinite(chart.lower[i]) && std::isfinite(chart.upper[i])) {
      path += (back.empty() ? "M" : "L") + point(x, y, chart.time[i], chart.upper[i]);
      back = "L" + point(x, y, chart.time[i], chart.lower[i]) + back;
    } else if (!back.empty()) {
      path += back + "Z";
      back.clear();
    }
  }
  return back.empty() ? path : path + back + "Z";
}

std::string path_element(const std::string& kind, const std::string& data) {
  return data.empty() ? "" : "<path class=\"" + kind + "\" d=\"" + data + "\"/>";
}

std::string label(const std::string& kind, const std::string& edge, double position, const std::string& text) {
  return "<span class=\"" + kind + "\" style=\"" + edge + ":" + exact_number(std::round(1e4 * position) / 100.0) + "%\">" +
         escape_html(text) + "</span>";
}

std::string tick_text(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  const int digits = static_cast<int>(std::ceil(std::log10(std::abs(value) / step) + 1e-9)) + 1;
  std::string text = short_number(value, std::clamp(digits, 1, 12));
  if (text.find('.') != std::string::npos && text.find('e') == std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

std::string grid_and_labels(const Axis& x, const Axis& y, std::string& labels) {
  std::string grid;
  const std::vector<double> levels = y.ticks(5), times = x.ticks(5);
  const auto step_at = [&](const std::vector<double>& ticks, std::size_t i) {
    if (ticks.size() < 2) return std::abs(ticks[i]) > 0.0 ? std::abs(ticks[i]) : 1.0;
    return i == 0 ? ticks[1] - ticks[0] : ticks[i] - ticks[i - 1];
  };
  for (std::size_t i = 0; i < levels.size(); ++i) {
    grid += "M0 " + coordinate(1.0 - y(levels[i])) + "H" + exact_number(view);
    labels += label("y", "bottom", y(levels[i]), tick_text(levels[i], step_at(levels, i)));
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    grid += "M" + coordinate(x(times[i])) + " 0V" + exact_number(view);
    labels += label("x", "left", x(times[i]), tick_text(times[i], step_at(times, i)));
  }
  labels += "<span class=\"axis\">time since the first frame [s]</span>";
  return path_element("grid", grid);
}

std::string legend(const Chart& chart) {
  std::string text = "<div class=\"legend\"><span><i></i>" + escape_html(chart.line_name) + "</span>";
  const auto entry = [&](const std::string& kind, const std::string& name) {
    text += "<span><i class=\"" + kind + "\"></i>" + escape_html(name) + "</span>";
  };
  if (!chart.lower.empty()) entry("band", chart.band_name);
  if (!chart.reference_name.empty()) entry("reference", chart.reference_name);
  if (!chart.skipped.empty()) entry("skip", "frame skipped");
  return text + "</div>";
}

}  // namespace

std::string Chart::html() const {
  const Axis x = time_axis(*this), y = value_axis(*this);
  std::string labels, skips, reference_path;
  const std::string grid = grid_and_labels(x, y, labels);
  for (const double when : skipped) skips += "M" + coordinate(x(when)) + " 960V1000";
  if (!reference_name.empty()) reference_path = "M0 " + coordinate(1.0 - y(reference)) + "H1000";
  const std::string caption = escape_html(title) + (unit.empty() ? "" : " [" + escape_html(unit) + "]");
  return "<figure><figcaption>" + caption + legend(*this) +
         "</figcaption><div class=\"plot\"><svg role=\"img\" aria-label=\"" + caption +
         " over time\" viewBox=\"0 0 1000 1000\" preserveAspectRatio=\"none\">" + grid +
         path_element("band", band_path(*this, x, y)) + path_element("reference", reference_path) +
         path_element("line", line_path(*this, x, y)) + path_element("skip", skips) + "</svg>" + labels +
         "</div></figure>\n";
}

std::vector<double> linear_ticks(double low, double high, int count) {
  const double rough = (high - low) / count, power = std::pow(10.0, std::floor(std::log10(rough)));
  const double multiple = rough / power;
  const double step = power * (multiple < 1.5 ? 1.0 : multiple < 3.5 ? 2.0 : multiple < 7.5 ? 5.0 : 10.0);
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k <= high / step + 1e-9; k += 1.0) ticks.push_back(k * step);
  return ticks;
}

std::vector<double> log_ticks(double low, double high) {
  const bool decades_only = high > 100.0 * low;
  std::vector<double> ticks;
  for (double decade = std::floor(std::log10(low)); decade <= std::log10(high); decade += 1.0) {
    for (const double multiple : {1.0, 2.0, 5.0}) {
      const double tick = multiple * std::pow(10.0, decade);
      if (tick >= low && tick <= high && (multiple == 1.0 || !decades_only)) ticks.push_back(tick);
    }
  }
  return ticks;
}

}  // namespace tissue_stiffness
