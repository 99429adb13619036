#include "tissue_stiffness/report/frame_charts.hpp"

#include <algorithm>
#include <cmath>

#include "tissue_stiffness/report/chart.hpp"
#include "tissue_stiffness/report/text.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t most_points = 1500;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The used frames in buckets of successive ones, small enough a number to draw.
std::vector<std::vector<const FrameRecord*>> buckets(const std::vector<FrameRecord>& frames) {
  std::vector<const FrameRecord*> used;
  for (const FrameRecord& frame : frames) {
    if (frame.used) used.push_back(&frame);
  }
  const std::size_t size = (used.size() + most_points - 1) / most_points;
  std::vector<std::vector<const FrameRecord*>> result;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (i % size == 0) result.emplace_back();
    result.back().push_back(used[i]);
  }
  return result;
}

Chart chart_of(const Results& results, const std::string& title, const std::string& unit) {
  Chart chart;
  chart.title = title;
  chart.unit = unit;
  for (const FrameRecord& frame : results.frames) {
    if (!frame.used) chart.skipped.push_back(frame.time - results.frames.front().time);
  }
  if (chart.skipped.size() > most_points) chart.skipped.resize(most_points);
  return chart;
}

Chart parameter_chart(const Results& results, std::size_t index) {
  const ParameterEstimate& last = results.parameters[index];
  const ShownUnit unit = shown_unit(last.mean, last.unit);
  Chart chart = chart_of(results, parameter_title(last.name), unit.name);
  chart.line_name = "mean";
  chart.band_name = "95 % interval";
  for (const auto& bucket : buckets(results.frames)) {
    double mean = nan, lower = nan, upper = nan;
    for (const FrameRecord* frame : bucket) {
      if (index >= frame->parameters.size()) continue;
      const ParameterEstimate& p = frame->parameters[index];
      mean = unit.scale * p.mean;
      lower = std::fmin(lower, unit.scale * p.lower95);
      upper = std::fmax(upper, unit.scale * p.upper95);
    }
    chart.time.push_back(bucket.back()->time - results.frames.front().time);
    chart.line.push_back(mean);
    chart.lower.push_back(lower);
    chart.upper.push_back(upper);
  }
  return chart;
}

double band_height(const Chart& chart, std::size_t from) {
  double low = nan, high = nan;
  for (std::size_t i = from; i < chart.lower.size(); ++i) {
    low = std::fmin(low, chart.lower[i]);
    high = std::fmax(high, chart.upper[i]);
  }
  return high - low;
}

/// The last three quarters alone, where the first quarter's band is much higher; empty otherwise.
std::string close_up(const Chart& chart) {
  const std::size_t quarter = chart.time.size() / 4;
  if (quarter == 0 || !(band_height(chart, 0) > 8.0 * band_height(chart, quarter))) return "";
  const auto keep = [&](std::vector<double> values) {
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(quarter));
    return values;
  };
  Chart part = chart;
  part.title += ", close-up of the later frames";
  part.time = keep(chart.time);
  part.line = keep(chart.line);
  part.lower = keep(chart.lower);
  part.upper = keep(chart.upper);
  const double first = part.time.front();
  part.skipped.erase(std::remove_if(part.skipped.begin(), part.skipped.end(), [&](double t) { return t < first; }),
                     part.skipped.end());
  return part.html();
}

std::string misfit_chart(const Results& results) {
  double largest = results.noise_rms;
  for (const FrameRecord& frame : results.frames) largest = std::fmax(largest, frame.misfit_rms);
  const ShownUnit unit = shown_unit(largest, "m");
  Chart chart = chart_of(results, "Misfit of each frame (rms)", unit.name);
  chart.line_name = "measurement - model";
  chart.from_zero = true;
  if (std::isfinite(results.noise_rms)) {
    chart.reference = unit.scale * results.noise_rms;
    chart.reference_name = "noise of the sensors";
  }
  for (const auto& bucket : buckets(results.frames)) {
    double misfit = nan;
    for (const FrameRecord* frame : bucket) misfit = std::fmax(misfit, unit.scale * frame->misfit_rms);
    chart.time.push_back(bucket.back()->time - results.frames.front().time);
    chart.line.push_back(misfit);
  }
  return chart.html();
}

}  // namespace

std::string parameter_title(const std::string& name) {
  const std::size_t dot = name.find('.');
  if (dot == std::string::npos) return name;
  std::string quantity = name.substr(dot + 1);
  std::replace(quantity.begin(), quantity.end(), '_', ' ');
  if (quantity.rfind("young modulus", 0) == 0) quantity.replace(0, 5, "Young's");
  return quantity + " (" + name.substr(0, dot) + ")";
}

std::string frame_charts(const Results& results) {
  if (results.used() == 0) return "";
  std::string text;
  for (std::size_t i = 0; i < results.parameters.size(); ++i) {
    const Chart chart = parameter_chart(results, i);
    text += "<section>" + chart.html() + close_up(chart) + "</section>\n";
  }
  return text + "<section>" + misfit_chart(results) + "</section>\n";
}

}  // namespace tissue_stiffness
