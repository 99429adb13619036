#include "nodes/repeated_observation.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

template <typename Matrix>
bool equal(const Matrix& a, const Matrix& b) {
  return a.cols() == b.cols() && a.rows() == b.rows() && a == b;
}

bool same(const Observation& a, const Observation& b) {
  if (a.source != b.source || a.time != b.time || !a.contour != !b.contour) return false;
  return equal(a.points, b.points) && equal(a.ids, b.ids) && (!a.contour || equal(a.contour->points, b.contour->points));
}

}  // namespace

bool is_repeated(const Observation& observation, const std::vector<Observation>& others) {
  return std::any_of(others.begin(), others.end(), [&](const Observation& other) { return same(observation, other); });
}

}  // namespace tissue_stiffness
