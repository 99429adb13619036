#include "tissue_stiffness/types/observation.hpp"

#include <limits>

namespace tissue_stiffness {

const ObservationTraits& traits_of(ObservationKind kind) {
  static const char* const cloud = "sensor_msgs/PointCloud2";
  static const char* const image = "sensor_msgs/Image";
  static const ObservationTraits vertices{"vertices", true, false, false, false, 3, cloud},
      markers{"markers", true, false, false, false, 3, cloud}, points{"points", false, false, false, false, 1, cloud},
      contour{"contour", false, true, false, false, 1, image}, tracks{"tracks", true, true, false, true, 2, image},
      reaction{"reaction", false, false, true, false, 3, "geometry_msgs/WrenchStamped"};
  switch (kind) {
    case ObservationKind::vertices:
      return vertices;
    case ObservationKind::markers:
      return markers;
    case ObservationKind::points:
      return points;
    case ObservationKind::contour:
      return contour;
    case ObservationKind::tracks:
      return tracks;
    case ObservationKind::reaction:
      break;
  }
  return reaction;
}

Eigen::Index Observation::row_count() const {
  return traits_of(kind).rows * (contour ? contour->size() : points.cols());
}

bool Observation::holds_anything() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (contour) return (contour->sigma.array() < infinity).any() && contour->points.array().isFinite().any();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (points.col(i).allFinite()) return true;
  }
  return false;
}

}  // namespace tissue_stiffness
