#include "observation/feature_anchors.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tissue_stiffness/types/error.hpp"
#include "types/median.hpp"
#include "types/sensor_ray.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSteepest = 5.0;  // distance of points of one surface, over that of their pixels in a plane across the ray

constexpr std::size_t kNeighbours = 8, kFewestNeighbours = 5;
constexpr double kOtherwise = 4.0;
constexpr double kAlike = 0.25;  // [pixel] by which neighbours differ anyway

// Returns the columns nearest to a column, without it.
std::vector<Eigen::Index> nearest(const Eigen::Matrix2Xd& places, Eigen::Index to) {
  std::vector<std::pair<double, Eigen::Index>> all;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    if (i != to) all.emplace_back((places.col(i) - places.col(to)).squaredNorm(), i);
  }
  const std::size_t count = std::min(kNeighbours, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
  std::vector<Eigen::Index> out;
  out.reserve(count);
  for (std::size_t k = 0; k < count; ++k) out.push_back(all[k].second);
  return out;
}

// Returns whether each column of a motion agrees with those around it.
std::vector<bool> agreeing(const Eigen::Matrix2Xd& places, const Eigen::Matrix2Xd& motion) {
  std::vector<bool> out;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const std::vector<Eigen::Index> around = nearest(places, i);
    Eigen::Vector2d middle;
    for (int c = 0; c < 2 && around.size() >= kFewestNeighbours; ++c) {
      std::vector<double> values;
      values.reserve(around.size());
      for (const Eigen::Index k : around) values.push_back(motion(c, k));
      middle[c] = median_of(values);
    }
    std::vector<double> differences;
    differences.reserve(around.size());
    for (const Eigen::Index k : around) differences.push_back((motion.col(k) - middle).norm());
    out.push_back(around.size() < kFewestNeighbours ||
                  (motion.col(i) - middle).norm() < kOtherwise * (median_of(differences) + kAlike));
  }
  return out;
}

// Leaves the features of these columns.
void keep(const std::vector<Eigen::Index>& columns, FeatureTracks& tracks) {
  const FeatureTracks all = tracks;
  const auto count = static_cast<Eigen::Index>(columns.size());
  tracks.ids.resize(count);
  tracks.pixels.resize(2, count);
  tracks.reference.resize(2, count);
  tracks.sigma.resize(count);
  tracks.windows.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index i = columns[static_cast<std::size_t>(k)];
    tracks.ids[k] = all.ids[i];
    tracks.pixels.col(k) = all.pixels.col(i);
    tracks.reference.col(k) = all.reference.col(i);
    tracks.sigma[k] = all.sigma[i];
    tracks.windows[k] = all.windows[i];
  }
}

}  // namespace

Observation FeatureAnchors::observe(const FeatureTracks& tracks, const Camera& camera, int source,
                                    const std::string& topic) {
  std::vector<Eigen::Index> own;
  for (Eigen::Index i = 0; i < tracks.size(); ++i) {
    const bool finite = tracks.pixels.col(i).allFinite() && tracks.reference.col(i).allFinite();
    if (finite && place(tracks, i, camera).facet >= 0) own.push_back(i);
  }
  auto kept = std::make_shared<FeatureTracks>(tracks);
  keep(own, *kept);
  const std::vector<bool> agree = agreeing(kept->reference, kept->pixels - kept->reference);
  own.clear();
  for (std::size_t k = 0; k < agree.size(); ++k) {
    if (agree[k]) own.push_back(static_cast<Eigen::Index>(k));
  }
  keep(own, *kept);
  if (kept->empty()) {
    throw InputError(topic, "an image with " + std::to_string(tracks.size()) + " features, none of which is the body's",
                     "features in front of the mesh at rest, as the camera's pose on tf places it");
  }
  Observation out;
  out.points.resize(3, kept->size());
  kept->facets.resize(kept->size());
  for (Eigen::Index k = 0; k < kept->size(); ++k) {
    const SurfacePoint& there = anchors_.at(kept->ids[k]).place;
    kept->facets[k] = there.facet;
    out.points.col(k) = there.point;
  }
  out.source = source;
  out.kind = ObservationKind::tracks;
  out.time = tracks.stamp;
  out.ids = kept->ids;
  out.tracks = std::move(kept);
  out.camera = std::make_shared<Camera>(camera);
  return out;
}

const SurfacePoint& FeatureAnchors::place(const FeatureTracks& tracks, Eigen::Index i, const Camera& camera) {
  const Eigen::Vector2d reference = tracks.reference.col(i);
  const auto known = anchors_.find(tracks.ids[i]);
  if (known != anchors_.end() && known->second.reference == reference) return known->second.place;
  SurfacePoint there = meet(reference, camera);
  if (!shows_body_alone(there, reference, tracks.windows[i], camera)) there.facet = -1;
  Anchor& anchor = anchors_[tracks.ids[i]];
  anchor = {reference, there};
  return anchor.place;
}

SurfacePoint FeatureAnchors::meet(const Eigen::Vector2d& pixel, const Camera& camera) const {
  return first_surface_point(mesh_, camera.model_from_sensor.translation(),
                             (camera.model_from_sensor.linear() * sensor_ray(camera, pixel)).normalized());
}

bool FeatureAnchors::shows_body_alone(const SurfacePoint& place, const Eigen::Vector2d& reference, double window,
                                      const Camera& camera) const {
  if (place.facet < 0 || window == 0.0) return place.facet >= 0;
  const double apart = kSteepest * std::sqrt(2.0) * window * place.distance / camera.fx;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, -1), Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, 1)}) {
    const SurfacePoint there = meet(reference + window * corner, camera);
    if (there.facet < 0 || (there.point - place.point).norm() > apart) return false;
  }
  return true;
}

std::map<int, FeatureAnchors> make_feature_anchors(const ModelSettings& settings, const TetMesh& mesh) {
  std::map<int, FeatureAnchors> out;
  for (std::size_t i = 0; i < settings.observations.size(); ++i) {
    if (settings.observations[i].kind == ObservationKind::tracks) out.emplace(static_cast<int>(i), FeatureAnchors(mesh));
  }
  return out;
}

}  // namespace tissue_stiffness
