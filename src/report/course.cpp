#include "report/course.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/text.hpp"

namespace tissue_stiffness {
namespace {

using nlohmann::json;

constexpr std::size_t kMostPoints = 1500;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Bucket = std::vector<const FrameRecord*>;

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

/// Returns the used frames in buckets of successive ones, few enough to draw.
std::vector<Bucket> buckets(const std::vector<FrameRecord>& frames) {
  Bucket used;
  for (const FrameRecord& frame : frames) {
    if (frame.used) used.push_back(&frame);
  }
  const std::size_t size = (used.size() + kMostPoints - 1) / kMostPoints;
  std::vector<Bucket> result;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (i % size == 0) result.emplace_back();
    result.back().push_back(used[i]);
  }
  return result;
}

json parameter_course(const ParameterEstimate& last, std::size_t index, const std::vector<Bucket>& all) {
  const ShownUnit unit = shown_unit(last.mean, last.unit);
  json means = json::array(), lowers = json::array(), uppers = json::array();
  for (const Bucket& bucket : all) {
    double mean = kNaN, lower = kNaN, upper = kNaN;
    for (const FrameRecord* frame : bucket) {
      if (index >= frame->parameters.size()) continue;
      const ParameterEstimate& p = frame->parameters[index];
      mean = unit.scale * p.mean;
      lower = std::fmin(lower, unit.scale * p.lower95);
      upper = std::fmax(upper, unit.scale * p.upper95);
    }
    means.push_back(number(mean));
    lowers.push_back(number(lower));
    uppers.push_back(number(upper));
  }
  return {{"name", last.name}, {"title", parameter_title(last.name)},
          {"unit", unit.name}, {"scale", unit.scale},
          {"mean", means},     {"lower", lowers},
          {"upper", uppers}};
}

/// Returns the largest value in each bucket.
template <typename Value>
json largest(const std::vector<Bucket>& all, const Value& value) {
  json out = json::array();
  for (const Bucket& bucket : all) {
    double most = kNaN;
    for (const FrameRecord* frame : bucket) most = std::fmax(most, value(*frame));
    out.push_back(number(most));
  }
  return out;
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

std::string course_json(const Results& results, double first_stamp) {
  const std::vector<Bucket> all = buckets(results.frames);
  json times = json::array(), parameters = json::array(), skipped = json::array();
  for (const Bucket& bucket : all) times.push_back(bucket.back()->time - first_stamp);
  for (std::size_t i = 0; i < results.parameters.size(); ++i) {
    parameters.push_back(parameter_course(results.parameters[i], i, all));
  }
  for (const FrameRecord& frame : results.frames) {
    if (!frame.used && skipped.size() < kMostPoints) skipped.push_back(frame.time - first_stamp);
  }
  const json out = {{"time", times},
                    {"parameters", parameters},
                    {"misfit", largest(all, [](const FrameRecord& f) { return 1e3 * f.misfit_rms; })},
                    {"sigmas", largest(all, [](const FrameRecord& f) { return f.misfit_sigma; })},
                    {"noise", number(1e3 * results.noise_rms)},
                    {"skipped", skipped}};
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace tissue_stiffness
