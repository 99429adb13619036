// Arrays are stored as base64 of small integers, which takes a fifth of the size of numbers in text.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "report/page.hpp"

namespace tissue_stiffness {
namespace {

using nlohmann::json;

constexpr double kSteps = 32000.0;          // of a 16-bit number to either side of the middle
constexpr std::int16_t kNothing = -32768;   // stands for NaN
constexpr double kShades = 254.0;           // of an 8-bit one
constexpr std::uint8_t kNothingSeen = 255;  // stands for NaN
constexpr double kOutlineStep = 0.1;        // [pixel]
constexpr Eigen::Index kMostOutlinePoints = 240;
constexpr std::size_t kMostArrowFrames = 120;

std::string base64(const std::string& bytes) {
  static const char* const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  const auto at = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U; };
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const unsigned triple = at(i) << 16U | at(i + 1) << 8U | at(i + 2);
    for (unsigned k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : letters[triple >> (18U - 6U * k) & 63U];
  }
  return out;
}

/// The bytes are little-endian on every machine.
void append(std::string& bytes, unsigned value, int size) {
  for (int k = 0; k < size; ++k) bytes += static_cast<char>(value >> (8U * static_cast<unsigned>(k)) & 255U);
}

/// Returns {offset, scale, data} with value = offset + scale * 16-bit number.
json shorts(const std::vector<double>& values) {
  double low = INFINITY, high = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const double offset = low <= high ? 0.5 * (low + high) : 0.0;
  const double scale = high > low ? 0.5 * (high - low) / kSteps : 1.0;
  std::string bytes;
  for (const double value : values) {
    const long number = std::isfinite(value) ? std::lround((value - offset) / scale) : kNothing;
    append(bytes, static_cast<unsigned>(number), 2);
  }
  return {{"offset", offset}, {"scale", scale}, {"data", base64(bytes)}};
}

std::vector<double> flat(const Eigen::MatrixXd& m) {
  return {m.data(), m.data() + m.size()};
}

/// Returns all frames, one after the other.
template <typename Matrix>
std::vector<double> flat(const std::vector<Matrix>& frames) {
  std::vector<double> all;
  for (const Matrix& frame : frames) all.insert(all.end(), frame.data(), frame.data() + frame.size());
  return all;
}

/// Returns {most, data} with value = most * (8-bit number / 254)^2, so that small values keep their digits.
json shades(const std::vector<Eigen::VectorXd>& frames) {
  const std::vector<double> all = flat(frames);
  double most = 0.0;
  for (const double value : all) most = std::isfinite(value) ? std::max(most, value) : most;
  std::string bytes;
  for (const double value : all) {
    const double share = most > 0.0 ? std::sqrt(value / most) : 0.0;
    append(bytes, std::isfinite(value) ? static_cast<unsigned>(std::lround(kShades * share)) : kNothingSeen, 1);
  }
  return {{"most", most}, {"data", base64(bytes)}};
}

json surface_json(const ReplaySurface& surface) {
  std::string corners;
  for (Eigen::Index i = 0; i < surface.triangles.size(); ++i) {
    append(corners, static_cast<unsigned>(surface.triangles.data()[i]), 2);
  }
  return {{"rest", shorts(flat(surface.rest))}, {"triangles", base64(corners)},
          {"frames", surface.frames},           {"displacement", shorts(flat(surface.displacement))},
          {"error", shades(surface.error)},     {"sigmas", shades(surface.sigmas)}};
}

json track_json(const ReplayTrack& track) {
  json components = json::array();
  for (std::size_t c = 0; c < track.components.size(); ++c) {
    const auto row = static_cast<Eigen::Index>(c);
    components.push_back({{"name", track.components[c]},
                          {"measured", shorts(flat(track.measured.row(row)))},
                          {"predicted", shorts(flat(track.predicted.row(row)))}});
  }
  return {{"name", track.name}, {"unit", track.unit}, {"components", components}};
}

/// Returns tenths of a pixel. Points without a number are left out.
std::vector<long> pixels(const Eigen::MatrixXd& points, Eigen::Index stride) {
  std::vector<long> out;
  for (Eigen::Index i = 0; i < points.cols(); i += stride) {
    if (!points.col(i).allFinite()) continue;
    for (Eigen::Index k = 0; k < points.rows(); ++k) out.push_back(std::lround(points(k, i) / kOutlineStep));
  }
  return out;
}

json outline_json(const ReplayOutline& outline) {
  const Eigen::Index stride = 1 + outline.measured.cols() / kMostOutlinePoints;
  return {{"source", outline.source},
          {"time", outline.time},
          {"width", outline.width},
          {"height", outline.height},
          {"closed", outline.closed},
          {"joined", outline.joined},
          {"measured", pixels(outline.measured, stride)},
          {"predicted", pixels(outline.predicted, 1)}};
}

/// Ten microseconds are precise enough for a clock.
std::vector<double> clock(const std::vector<double>& times) {
  std::vector<double> out;
  for (const double time : times) out.push_back(std::round(1e5 * time) / 1e5);
  return out;
}

json load_json(const ReplayLoad& load) {
  return {{"name", load.name},
          {"unit", load.unit},
          {"place", {load.place.x(), load.place.y(), load.place.z()}},
          {"value", shorts(flat(load.value))}};
}

json replay_json(const Replay& replay) {
  json tracks = json::array(), outlines = json::array(), rms = json::array(), loads = json::array();
  for (const ReplayLoad& load : replay.loads) loads.push_back(load_json(load));
  for (const ReplayTrack& track : replay.tracks) tracks.push_back(track_json(track));
  for (const ReplayOutline& outline : replay.outlines) outlines.push_back(outline_json(outline));
  for (const double value : replay.rms) rms.push_back(std::isfinite(value) ? json(value) : json(nullptr));
  return {{"name", replay.name}, {"time", clock(replay.time)}, {"rms", rms},     {"surface", surface_json(replay.surface)},
          {"tracks", tracks},    {"outlines", outlines},       {"loads", loads}, {"held", shorts(flat(replay.held))}};
}

}  // namespace

std::string arrows_json(const MissingForce& force) {
  if (force.time.empty()) return "null";
  std::vector<double> time, field;
  const std::size_t stride = 1 + force.time.size() / kMostArrowFrames;
  for (std::size_t k = 0; k < force.time.size(); k += stride) {
    time.push_back(force.time[k]);
    const Eigen::Matrix3Xd& at = force.at_nodes[k];
    field.insert(field.end(), at.data(), at.data() + at.size());
  }
  return json({{"time", clock(time)}, {"places", shorts(flat(force.places))}, {"field", shorts(field)}}).dump();
}

std::string showing_json(const Showing& showing) {
  json replays = json::array(), pictures = json::array();
  for (const Replay& replay : showing.replays) replays.push_back(replay_json(replay));
  for (const Picture& picture : showing.pictures) {
    pictures.push_back({{"source", picture.source},
                        {"time", picture.stamp - showing.first_stamp},
                        {"jpeg", "data:image/jpeg;base64," + base64(picture.jpeg)}});
  }
  const json out = {{"first_stamp", showing.first_stamp}, {"replays", replays}, {"pictures", pictures}};
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace tissue_stiffness
