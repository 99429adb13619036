#include "estimation/replay_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kMostFrames = 480;
constexpr std::size_t kMostVertices = 1600;
constexpr std::size_t kSurfaceNumbers = 90000;  // vertices x frames of the surface
constexpr std::size_t kTrackNumbers = 32000;    // tracks x frames
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Drops every second entry: what held every frame then holds every second one.
template <typename List>
void halve(List& list) {
  std::size_t to = 1;
  for (std::size_t from = 2; from < list.size(); from += 2) list[to++] = std::move(list[from]);
  list.resize(to);
}

/// Returns the left, right, upper and lower edge [pixel]; NaN without points.
Eigen::Vector4d edges(const Eigen::Matrix2Xd& points) {
  Eigen::Vector4d out = Eigen::Vector4d::Constant(kNaN);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!points.col(i).allFinite()) continue;
    out[0] = std::fmin(out[0], points(0, i));
    out[1] = std::fmax(out[1], points(0, i));
    out[2] = std::fmin(out[2], points(1, i));
    out[3] = std::fmax(out[3], points(1, i));
  }
  return out;
}

/// These are the points of an outline that the model has a counterpart for, and the counterparts [pixel].
struct FacingPoints {
  Eigen::Matrix2Xd measured, predicted;
};
FacingPoints facing_points(const Contour& contour, const Prediction& p, Eigen::Index from) {
  const Eigen::Index n = contour.size();
  FacingPoints out{contour.points, Eigen::Matrix2Xd::Constant(2, n, kNaN)};
  if (n == 0) return out;
  Eigen::Index far = 0;
  (contour.points.colwise() - contour.points.col(0)).colwise().squaredNorm().maxCoeff(&far);
  const double pixels = (contour.points.col(far) - contour.points.col(0)).norm();
  const double scale = (p.places.col(from + far) - p.places.col(from)).norm() / pixels;  // metres per pixel
  for (Eigen::Index i = 0; i < n; ++i) {
    out.predicted.col(i) = contour.points.col(i) + contour.normals.col(i) * p.predicted[from + i] / scale;
    if (!out.predicted.col(i).allFinite()) out.measured.col(i).setConstant(kNaN);
  }
  return out;
}

double mean_finite(const Eigen::VectorXd& values) {
  double sum = 0.0, count = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) sum += values[i], count += 1.0;
  }
  return count > 0.0 ? sum / count : kNaN;
}

}  // namespace

ReplayRecorder::ReplayRecorder(const TetMesh& mesh, double first_stamp, const std::vector<double>& picture_stamps)
    : thin_(mesh, kMostVertices),
      first_stamp_(first_stamp),
      picture_stamps_(picture_stamps.begin(), picture_stamps.end()),
      most_surfaces_(std::min(kMostFrames, kSurfaceNumbers / std::max<std::size_t>(1, thin_.members.size()))) {
  const Eigen::Map<const Eigen::VectorXd> rest(mesh.nodes.data(), mesh.nodes.size());
  replay_.surface.rest = thin_.mean(rest);
  replay_.surface.triangles = thin_.triangles;
}

void ReplayRecorder::add(const FreeFrame& frame) {
  const std::size_t number = count_++;
  for (const Observation& observation : frame.frame.observations) {
    if (traits_of(observation.kind).image && picture_stamps_.count(observation.time) > 0) add_outline(observation, frame);
  }
  if (number % surface_stride_ == 0) {
    add_surface(frame);
    ReplaySurface& surface = replay_.surface;
    surface.frames.push_back(static_cast<int>(number));
    if (surface.frames.size() > most_surfaces_) {
      halve(surface.frames);
      halve(surface.displacement);
      halve(surface.error);
      halve(surface.sigmas);
      surface_stride_ *= 2;
    }
  }
  if (number % stride_ != 0) return;
  replay_.time.push_back(frame.frame.time - first_stamp_);
  replay_.rms.push_back(frame.misfit.rms);
  add_tracks(frame);
  if (replay_.time.size() > kMostFrames) {
    halve(replay_.time);
    halve(replay_.rms);
    halve(seen_);
    stride_ *= 2;
  }
}

void ReplayRecorder::add_tracks(const FreeFrame& frame) {
  seen_.emplace_back();
  Eigen::Index from = 0;
  for (const Observation& observation : frame.frame.observations) {
    const Eigen::Index rows = observation.row_count();
    const Key whole{observation.source, -1};
    const ObservationTraits& traits = traits_of(observation.kind);
    if (observation.contour) {
      kinds_[whole] = observation.kind;
      const FacingPoints points = facing_points(*observation.contour, frame.prediction, from);
      seen_.back()[whole] = {edges(points.measured), edges(points.predicted)};
    } else if (traits.force) {
      kinds_[whole] = observation.kind;
      seen_.back()[whole] = {frame.prediction.measured.segment(from, rows), frame.prediction.predicted.segment(from, rows)};
    } else if (!traits.identified) {
      kinds_[whole] = observation.kind;
      const Prediction& p = frame.prediction;
      const double distance = mean_finite(p.measured.segment(from, rows) - p.predicted.segment(from, rows));
      seen_.back()[whole] = {Eigen::VectorXd::Constant(1, distance), Eigen::VectorXd::Zero(1)};
    } else {
      add_named(observation, frame.prediction, from);
    }
    from += rows;
  }
}

void ReplayRecorder::add_named(const Observation& observation, const Prediction& p, Eigen::Index from) {
  const Eigen::Index rows = traits_of(observation.kind).rows;
  for (Eigen::Index i = 0; i < observation.ids.size(); ++i) {
    const Key key{observation.source, observation.ids[i]};
    kinds_[key] = observation.kind;
    seen_.back()[key] = {p.measured.segment(from + rows * i, rows), p.predicted.segment(from + rows * i, rows)};
  }
}

void ReplayRecorder::add_outline(const Observation& observation, const FreeFrame& frame) {
  ReplayOutline out;
  out.source = observation.source;
  out.time = observation.time - first_stamp_;
  out.joined = observation.contour != nullptr;
  out.width = out.joined ? observation.contour->width : observation.tracks->width;
  out.height = out.joined ? observation.contour->height : observation.tracks->height;
  out.closed = out.joined && observation.contour->closed;
  out.measured = out.joined ? observation.contour->points : observation.tracks->pixels;
  out.predicted = frame.outline(observation);
  replay_.outlines.push_back(std::move(out));
}

void ReplayRecorder::add_surface(const FreeFrame& frame) {
  replay_.surface.displacement.push_back(thin_.mean(frame.displacement));
  replay_.surface.error.push_back(thin_.rms(frame.misfit.node_error));
  replay_.surface.sigmas.push_back(thin_.rms(frame.misfit.node_sigmas));
}

ReplayTrack ReplayRecorder::track(const Key& key, ObservationKind kind) const {
  ReplayTrack out;
  out.unit = "m";
  if (kind == ObservationKind::contour) {
    out.name = "outline " + std::to_string(key.first + 1);
    out.unit = "pixel";
    out.components = {"left edge", "right edge", "upper edge", "lower edge"};
  } else if (traits_of(kind).force) {
    out.name = "reaction " + std::to_string(key.first + 1);
    out.unit = "N";
    out.components = {"x", "y", "z"};
  } else if (!traits_of(kind).identified) {
    out.name = "points " + std::to_string(key.first + 1);
    out.components = {"mean distance from the surface"};
  } else if (kind == ObservationKind::tracks) {
    out.name = "feature " + std::to_string(key.second);
    out.components = {"right", "down"};
  } else {
    out.name = (kind == ObservationKind::vertices ? "vertex " : "marker ") + std::to_string(key.second);
    out.components = {"x", "y", "z"};
  }
  const auto rows = static_cast<Eigen::Index>(out.components.size());
  out.measured = Eigen::MatrixXd::Constant(rows, static_cast<Eigen::Index>(seen_.size()), kNaN);
  out.predicted = out.measured;
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    const auto found = seen_[k].find(key);
    if (found == seen_[k].end()) continue;
    out.measured.col(static_cast<Eigen::Index>(k)) = found->second.measured;
    out.predicted.col(static_cast<Eigen::Index>(k)) = found->second.predicted;
  }
  return out;
}

Replay ReplayRecorder::finish() {
  const std::size_t most = std::max<std::size_t>(8, kTrackNumbers / std::max<std::size_t>(1, seen_.size()));
  const std::size_t step = (kinds_.size() + most - 1) / most;
  std::size_t number = 0;
  for (const auto& [key, kind] : kinds_) {
    if (number++ % step == 0) replay_.tracks.push_back(track(key, kind));
  }
  // Both strides are powers of two, and the surface's is never the shorter one.
  ReplaySurface& surface = replay_.surface;
  for (int& frame : surface.frames) frame /= static_cast<int>(stride_);
  return std::move(replay_);
}

}  // namespace tissue_stiffness
