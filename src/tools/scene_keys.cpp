#include "tools/scene_keys.hpp"

#include <limits>

namespace tissue_stiffness {
namespace {

using Kind = KeySpec::Kind;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPositive = std::numeric_limits<double>::min();
constexpr int kMost = std::numeric_limits<int>::max();

// These functions make keys below `simulation`.
KeySpec number(const std::string& path, const std::string& unit, double lower, double upper, double value,
               const std::string& meaning) {
  return number_key("simulation." + path, unit, lower, upper, value, meaning);
}
KeySpec needed(const std::string& path, const std::string& unit, double lower, double upper, const std::string& meaning) {
  return required_number("simulation." + path, unit, lower, upper, meaning);
}
KeySpec integer(const std::string& path, int lower, int upper, int value, const std::string& meaning) {
  return integer_key("simulation." + path, lower, upper, value, meaning);
}
KeySpec other(const std::string& path, Kind kind, const std::string& unit, bool required, const std::string& meaning) {
  return (required ? required_key : plain_key)("simulation." + path, kind, unit, meaning);
}

std::vector<KeySpec> run_keys() {
  return {required_key("simulation", Kind::map, "", "how the scene is run and recorded"),
          needed("duration", "s", kPositive, kInfinity, "of the recording"),
          needed("rate", "Hz", kPositive, 1e6, "of the frames"),
          needed("step", "s", kPositive, kInfinity, "of the integration"),
          number("spectral_radius", "", 0, 1, 1, "of generalised-alpha; 1: Newmark's average acceleration"),
          integer("refine", 0, 4, 0, "how often the mesh is refined, eightfold each time"),
          integer("seed", 0, kMost, 1, "of all noise")};
}

std::vector<KeySpec> load_keys() {
  const std::string term = "loads.*.terms[].";
  const double any = -kInfinity;
  return {other("loads", Kind::map, "", false, "one entry for each `topic` of an effect"),
          other("loads.*", Kind::map, "", false, "the load on that topic: a sum of terms"),
          needed("loads.*.rate", "Hz", kPositive, 1e5, "of its messages"),
          number("loads.*.noise", "N, Pa or m", 0, kInfinity, 0, "1 sigma of what is published; what acts is without"),
          other("loads.*.terms", Kind::list, "", true, "each a direction and one of the courses below"),
          other("loads.*.position", Kind::numbers, "m", false, "of a pose before it moves; the origin when absent"),
          other(term + "direction", Kind::numbers, "", false, "[x, y, z] of a force or a pose's way; a pressure has none"),
          other(term + "axis", Kind::numbers, "", false,
                "[x, y, z] about which a pose turns by so many rad, in place of "
                "`direction`"),
          other(term + "ramp", Kind::map, "", false, "from one value to another"),
          number(term + "ramp.from", "N, Pa, m or rad", any, kInfinity, 0, "before it starts"),
          needed(term + "ramp.to", "N, Pa, m or rad", any, kInfinity, "after it ends"),
          needed(term + "ramp.start", "s", 0, kInfinity, "since the recording's start"),
          needed(term + "ramp.end", "s", 0, kInfinity, "not before `start`"),
          other(term + "sine", Kind::map, "", false, "amplitude sin(2 pi frequency t + phase)"),
          needed(term + "sine.amplitude", "N, Pa, m or rad", any, kInfinity, "of it"),
          needed(term + "sine.frequency", "Hz", 0, kInfinity, "of it"),
          number(term + "sine.phase", "rad", any, kInfinity, 0, "of it"),
          other(term + "raised_cosine", Kind::map, "", false, "amplitude (1 - cos(2 pi frequency t)) / 2"),
          needed(term + "raised_cosine.amplitude", "N, Pa, m or rad", any, kInfinity, "its peak"),
          needed(term + "raised_cosine.frequency", "Hz", 0, kInfinity, "of it"),
          other(term + "steps", Kind::map, "", false, "constant from each time to the next, 0 before the first"),
          other(term + "steps.times", Kind::list, "s", true, "ascending"),
          other(term + "steps.values", Kind::list, "N, Pa, m or rad", true, "as many"),
          other(term + "csv", Kind::map, "", false, "a course from a file"),
          other(term + "csv.file", Kind::text, "", true, "two columns: time since the start [s], value")};
}

std::vector<KeySpec> sensor_keys() {
  const std::string of = "sensors.*.";
  return {other("sensors", Kind::map, "", false, "one entry for each contour and for tracks; clouds may have one"),
          other("sensors.*", Kind::map, "", false, "the sensor on that topic"),
          number(of + "noise", "m or grey values", 0, kInfinity, std::numeric_limits<double>::quiet_NaN(),
                 "1 sigma of a coordinate, or of an image's grey values (0 to 255); the observation's, or 3, when absent"),
          number(of + "memory", "", 0, 0.99, 0, "correlation of a tracked point's noise from one frame to the next"),
          integer(of + "every", 1, kMost, 1, "of the surface's vertices"),
          other(of + "ids", Kind::list, "", false, "vertices of the mesh, instead of `every`"),
          integer(of + "count", 1, 1000000, 500, "random points of the surface in a frame"),
          other(of + "size", Kind::numbers, "pixel", false, "[width, height] of the images; [640, 480] when absent"),
          number(of + "blur", "pixel", 0, 20, 0.8, "1 sigma of the optics"),
          needed(of + "focal_length", "pixel", kPositive, kInfinity, "of a pinhole camera"),
          other(of + "distortion", Kind::list, "", false, "of its lens, as D of sensor_msgs/CameraInfo; none when absent"),
          choice_key("simulation." + of + "distortion_model", {"plumb_bob", "rational_polynomial", "equidistant"}, false,
                     "which model the lens has"),
          other(of + "position", Kind::numbers, "m", true, "of a pinhole camera"),
          other(of + "target", Kind::numbers, "m", true, "what it looks at"),
          other(of + "up", Kind::numbers, "", false, "up in its images; z when absent"),
          needed(of + "pixels_per_metre", "pixel/m", kPositive, kInfinity, "of a B-mode slice"),
          other(of + "apex", Kind::numbers, "m", true, "of its sector"),
          other(of + "axis", Kind::numbers, "", true, "along which it looks"),
          other(of + "lateral", Kind::numbers, "", true, "across, in the slice"),
          needed(of + "sector", "degree", 1, 180, "full angle"),
          needed(of + "depth", "m", kPositive, kInfinity, "of the slice"),
          number(of + "drop_out", "", 0, 0.5, 0, "part of the wall's beams that are lost")};
}

}  // namespace

const std::vector<KeySpec>& scene_keys() {
  static const std::vector<KeySpec> keys = [] {
    std::vector<KeySpec> all = run_keys();
    for (const std::vector<KeySpec>& more : {load_keys(), sensor_keys()}) all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return keys;
}

const KeySpec& scene_key(const std::string& path) {
  return find_key(scene_keys(), "simulation." + path);
}

}  // namespace tissue_stiffness
