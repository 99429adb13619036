#include "tissue_stiffness/types/observation.hpp"

#include <limits>

namespace tissue_stiffness {

const ObservationTraits& traits_of(ObservationKind kind) {
  static const char* const cloud = "sensor_msgs/PointCloud2";
  static const ObservationTraits vertices{"vertices", true, false, false, cloud},
      markers{"markers", true, false, false, cloud}, points{"points", false, false, false, cloud},
      contour{"contour", false, true, false, "sensor_msgs/Image"},
      reaction{"reaction", false, false, true, "geometry_msgs/WrenchStamped"};
  switch (kind) {
    case ObservationKind::vertices:
      return vertices;
    case ObservationKind::markers:
      return markers;
    case ObservationKind::points:
      return points;
    case ObservationKind::contour:
      return contour;
    case ObservationKind::reaction:
      break;
  }
  return reaction;
}

Eigen::Index Observation::row_count() const {
  const ObservationTraits& traits = traits_of(kind);
  if (traits.image) return contour->size();
  return traits.identified || traits.force ? points.size() : points.cols();
}

bool Observation::holds_anything() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (traits_of(kind).image) return (contour->sigma.array() < infinity).any() && contour->points.array().isFinite().any();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (points.col(i).allFinite()) return true;
  }
  return false;
}

}  // namespace tissue_stiffness
