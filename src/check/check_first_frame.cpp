#include "check/check_first_frame.hpp"

#include <algorithm>
#include <cmath>

#include "check/rigid_fit.hpp"
#include "check/starts_in_motion.hpp"
#include "check/words.hpp"
#include "meshing/surface.hpp"
#include "types/body_size.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSigmas = 3.0;            // of all tolerances together
constexpr Eigen::Index kMostPoints = 200;  // of a cloud without identities: enough for six degrees of freedom
constexpr double kSmallTurn = 0.5;         // [degree] not worth saying
constexpr double kLargestScaleError = 0.2;
constexpr double kFits = 0.5;  // of the distance: what a rigid motion that explains it leaves at most

std::string shown(const Eigen::Vector3d& v, double scale) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += (i > 0 ? ", " : "[") + plain_number(std::round(1e3 * scale * v[i]) / 1e3, 4);
  return text + "]";
}

Eigen::Matrix3Xd pick(const Eigen::Matrix3Xd& all, const std::vector<int>& columns) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = all.col(columns[i]);
  return out;
}

Eigen::Matrix3Xd thinned(const Eigen::Matrix3Xd& points) {
  const Eigen::Index stride = (points.cols() + kMostPoints - 1) / kMostPoints;
  Eigen::Matrix3Xd out(3, (points.cols() + stride - 1) / stride);
  for (Eigen::Index i = 0; i < out.cols(); ++i) out.col(i) = points.col(i * stride);
  return out;
}

/// Returns the root mean square distance from the middle, or of a single point from the origin [m].
double spread(const Eigen::Matrix3Xd& points) {
  const Eigen::Vector3d middle = points.cols() > 1 ? Eigen::Vector3d(points.rowwise().mean()) : Eigen::Vector3d::Zero();
  return std::sqrt((points.colwise() - middle).squaredNorm() / static_cast<double>(points.cols()));
}

/// A cloud and the positions of its points at rest. They are the points' own, or the nodes of the whole surface.
struct Cloud {
  const ObservationSettings& settings;
  const TetMesh& mesh;
  Eigen::Matrix3Xd points, rest;
  bool named() const { return traits_of(settings.kind).identified; }
  double distance() const {
    if (!named()) return distance_from_surface(points, mesh);
    return std::sqrt((points - rest).squaredNorm() / static_cast<double>(points.cols()));
  }
  RigidFit fit() const { return named() ? fit_pairs(points, rest) : fit_surface(points, mesh); }
};

Cloud make_cloud(const ObservationSettings& settings, const TetMesh& mesh, const Observation& seen) {
  const std::vector<int> ids(seen.ids.data(), seen.ids.data() + seen.ids.size());
  switch (settings.kind) {
    case ObservationSettings::Kind::vertices:
      return {settings, mesh, seen.points, pick(mesh.nodes, ids)};
    case ObservationSettings::Kind::markers:
      return {settings, mesh, seen.points, pick(settings.rest, ids)};
    default:
      return {settings, mesh, thinned(seen.points), pick(mesh.nodes, surface_nodes(mesh))};
  }
}

/// Returns the root mean square distance between points that both observations have [m]; 0 without identities.
double rms_distance(const Observation& a, const Observation& b) {
  double sum = 0.0, count = 0.0;
  for (Eigen::Index i = 0; i < std::min(a.ids.size(), b.ids.size()); ++i) {
    if (a.ids[i] != b.ids[i]) continue;
    sum += (a.points.col(i) - b.points.col(i)).squaredNorm();
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

double motion_since_rest(const FirstFrames& frames, const Observation& seen) {
  if (frames.second == nullptr) return 0.0;
  const double interval = frames.second->time - frames.first.time;
  for (const Observation& next : frames.second->observations) {
    if (next.source != seen.source || !(interval > 0.0)) continue;
    return rms_distance(seen, next) * std::max(1.0, (frames.first.time - frames.rest_time) / interval);
  }
  return 0.0;
}

std::string rigid_words(const Cloud& cloud, const RigidFit& fit, double distance) {
  if (fit.rms > kFits * distance) {
    return "no rigid motion makes it fit (" + millimetres(fit.rms) +
           " stay), so look for another body's mesh, or for a `time.start` at which the body was not at rest "
           "(a body that moves then needs the effect `initial_motion`).";
  }
  const Eigen::Vector3d middle = cloud.points.rowwise().mean();
  const Eigen::AngleAxisd turn(fit.motion.linear());
  const double degrees = turn.angle() * 180.0 / M_PI;
  const std::string shift = "a shift of " + shown(fit.motion * middle - middle, 1e3) + " mm";
  return "it fits to within " + millimetres(fit.rms) + " after " + shift +
         (degrees < kSmallTurn ? ""
                               : " and a turn of " + plain_number(degrees) + " degrees about " + shown(turn.axis(), 1.0)) +
         ", so mend the sensor's pose on tf or the mesh's place.";
}

SetupFindings check_unit(const Cloud& cloud) {
  const double own = spread(cloud.points), expected = spread(cloud.rest), ratio = own / expected;
  if (!(own > 0.0) || !(expected > 0.0) || (ratio < kPrefixSlip && ratio * kPrefixSlip > 1.0)) return {};
  const std::string& topic = cloud.settings.topic;
  const bool larger = ratio > 1.0;
  if (!larger && !cloud.named()) return {};  // a small patch of the surface
  return {{topic, topic + ": the points spread over " + plain_number(own) + " m where the mesh has " +
                      plain_number(expected) + " m, and both have to be in m; " +
                      (larger ? "if the cloud is in mm, divide its coordinates by 1000 before it is published."
                              : "if the mesh is in mm, write `scale: 0.001` in `mesh`.")}};
}

/// Returns whether a sensor with a slightly wrong scale explains the points. A diagnosis can name this effect,
/// `image_scale`, and an estimate can include it. No pose compensates it.
bool is_scaled(const Cloud& cloud, double allowed, double rigid_rms) {
  if (!cloud.named()) return false;
  const double scale = cloud.points.cwiseProduct(cloud.rest).sum() / cloud.rest.squaredNorm();
  const double left =
      std::sqrt((cloud.points - scale * cloud.rest).squaredNorm() / static_cast<double>(cloud.points.cols()));
  return std::abs(scale - 1.0) < kLargestScaleError && left < allowed && left < rigid_rms;
}

SetupFindings check_place(const Cloud& cloud, const MeshSettings& mesh, double motion) {
  const ObservationSettings& settings = cloud.settings;
  const double size = body_size(cloud.mesh.nodes);
  const double distance = cloud.distance();
  const double variance = 3.0 * settings.noise * settings.noise + 3.0 * settings.offset * settings.offset +
                          std::pow(settings.rotation * size, 2) + std::pow(mesh.scale_tolerance * size, 2);
  const double allowed = std::sqrt(kSigmas * kSigmas * variance + motion * motion);
  if (distance <= allowed) return {};
  const RigidFit fit = cloud.fit();
  if (is_scaled(cloud, allowed, fit.rms)) return {};
  return {{settings.topic, settings.topic + ": the first frame lies " + millimetres(distance) + " off the mesh, " +
                               plain_number(distance / settings.noise, 2) + " times the noise, where " +
                               millimetres(allowed) + " are within the tolerances; " + rigid_words(cloud, fit, distance)}};
}

}  // namespace

SetupFindings check_first_frame(const ModelSettings& settings, const TetMesh& mesh, const FirstFrames& frames) {
  SetupFindings findings;
  for (const Observation& seen : frames.first.observations) {
    const ObservationTraits& traits = traits_of(seen.kind);
    if (traits.image || traits.force || seen.points.cols() == 0) continue;
    const Cloud cloud = make_cloud(settings.observations[static_cast<std::size_t>(seen.source)], mesh, seen);
    const SetupFindings unit = check_unit(cloud);
    if (!unit.empty()) {
      append(findings, unit);
    } else if (!starts_in_motion(settings)) {
      append(findings, check_place(cloud, settings.mesh, motion_since_rest(frames, seen)));
    }
  }
  return findings;
}

}  // namespace tissue_stiffness
