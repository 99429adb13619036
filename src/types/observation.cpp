#include "tissue_stiffness/types/observation.hpp"

#include <limits>

namespace tissue_stiffness {

const ObservationTraits& traits_of(ObservationKind kind) {
  static const ObservationTraits vertices{"vertices", true, false}, markers{"markers", true, false},
      points{"points", false, false}, contour{"contour", false, true};
  switch (kind) {
    case ObservationKind::vertices:
      return vertices;
    case ObservationKind::markers:
      return markers;
    case ObservationKind::points:
      return points;
    case ObservationKind::contour:
      break;
  }
  return contour;
}

Eigen::Index Observation::row_count() const {
  const ObservationTraits& traits = traits_of(kind);
  return traits.image ? contour->size() : traits.identified ? 3 * ids.size() : points.cols();
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
