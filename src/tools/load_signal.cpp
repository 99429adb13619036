#include "tools/load_signal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "effects/course.hpp"
#include "settings/inside_folder.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/scene_keys.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const KeySpec& key(const std::string& name) {
  return scene_key("loads.*.terms[]." + name);
}

Signal read_ramp(const Value& map) {
  const double from = read_number(map, key("ramp.from"));
  const double to = read_number(map, key("ramp.to"));
  const double start = read_number(map, key("ramp.start"));
  const double end = map.at("end").as_number(start, kInfinity, "s");
  return [=](double t) {
    if (t >= end) return to;
    return t <= start ? from : from + (to - from) * (t - start) / (end - start);
  };
}

Signal read_sine(const Value& map) {
  const double amplitude = read_number(map, key("sine.amplitude")), frequency = read_number(map, key("sine.frequency"));
  const double phase = read_number(map, key("sine.phase"));
  return [=](double t) { return amplitude * std::sin(2.0 * M_PI * frequency * t + phase); };
}

Signal read_raised_cosine(const Value& map) {
  const double amplitude = read_number(map, key("raised_cosine.amplitude"));
  const double frequency = read_number(map, key("raised_cosine.frequency"));
  return [=](double t) { return 0.5 * amplitude * (1.0 - std::cos(2.0 * M_PI * frequency * t)); };
}

Signal read_steps(const Value& map) {
  std::vector<double> times, values;
  for (const Value& item : map.at("times").items()) {
    times.push_back(item.as_number(times.empty() ? 0.0 : times.back(), kInfinity, "s"));
  }
  for (const Value& item : map.at("values").items()) values.push_back(item.as_number(-kInfinity, kInfinity, ""));
  if (times.empty() || times.size() != values.size()) {
    throw InputError(map.path(), std::to_string(times.size()) + " times and " + std::to_string(values.size()) + " values",
                     "as many values as times, at least one");
  }
  return [times, values](double t) {
    const auto passed = std::upper_bound(times.begin(), times.end(), t) - times.begin();
    return passed == 0 ? 0.0 : values[static_cast<std::size_t>(passed) - 1];
  };
}

Signal read_csv(const Value& map, const std::string& directory) {
  const std::string file = path_from(directory, read_text(map, key("csv.file")));
  const auto course = std::make_shared<const Course>(Course::from_csv(file, LoadInput::Kind::pressure));
  return [course](double t) { return course->value(t, 0); };
}

}  // namespace

Signal read_signal(const Value& map, const std::string& directory) {
  if (map.has("ramp")) return read_ramp(map.at("ramp"));
  if (map.has("sine")) return read_sine(map.at("sine"));
  if (map.has("raised_cosine")) return read_raised_cosine(map.at("raised_cosine"));
  if (map.has("steps")) return read_steps(map.at("steps"));
  if (map.has("csv")) return read_csv(map.at("csv"), directory);
  throw InputError(map.path(), map.shown(), "one of ramp, sine, raised_cosine, steps, csv");
}

}  // namespace tissue_stiffness
