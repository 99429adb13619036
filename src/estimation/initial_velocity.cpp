#include "estimation/initial_velocity.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "types/sensor_ray.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kRelativeUncertainty = 0.05;  // of the speed: the body already decelerates or turns within the frames

// Returns the area centroid of a closed outline [pixel].
Eigen::Vector2d centroid(const Eigen::Matrix2Xd& points) {
  const Eigen::Vector2d origin = points.col(0);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double area = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector2d a = points.col(i) - origin, b = points.col((i + 1) % points.cols()) - origin;
    const double cross = a.x() * b.y() - b.x() * a.y();
    area += cross;
    sum += cross / 3.0 * (a + b);
  }
  return area != 0.0 ? Eigen::Vector2d(origin + sum / area) : Eigen::Vector2d(points.rowwise().mean());
}

Eigen::Vector3d centre(const Observation& observation, const Eigen::Vector3d& body_centre) {
  if (!traits_of(observation.kind).image) return observation.points.rowwise().mean();
  const Camera& camera = *observation.camera;
  const Eigen::Vector2d pixel = observation.contour ? centroid(observation.contour->points)
                                                    : Eigen::Vector2d(observation.tracks->pixels.rowwise().mean());
  return place_of(camera, pixel, depth_of(camera, body_centre));
}

}  // namespace

VelocityEstimate velocity_from_frames(const Model& model, const std::vector<Frame>& frames) {
  const Eigen::Vector3d body = model.mesh().nodes.rowwise().mean();
  const auto n = static_cast<Eigen::Index>(frames.size());
  Eigen::VectorXd times(n);
  Eigen::Matrix3Xd centres(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Frame& frame = frames[static_cast<std::size_t>(i)];
    times[i] = frame.time - frames.front().time;
    centres.col(i) = centre(frame.observations.front(), body);
  }
  const Eigen::VectorXd centred = times.array() - times.mean();
  VelocityEstimate estimate;
  estimate.mean = centres * centred / centred.squaredNorm();
  const double noise =
      model.settings().observations[static_cast<std::size_t>(frames.front().observations.front().source)].noise;
  estimate.std = std::hypot(noise / centred.norm(), kRelativeUncertainty * estimate.mean.norm());
  return estimate;
}

}  // namespace tissue_stiffness
