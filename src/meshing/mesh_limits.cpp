#include "meshing/mesh_limits.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

std::string metres(double value) {
  std::ostringstream text;
  text << value << " m";
  return text.str();
}

}  // namespace

void check_body_size(const Eigen::Matrix3Xd& points, const std::string& where) {
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!points.col(i).allFinite()) {
      throw InputError(where, "vertex " + std::to_string(i) + " with a coordinate that is not finite", "finite numbers");
    }
    const double most = points.col(i).cwiseAbs().maxCoeff();
    if (most > kFarthestPoint) {
      throw InputError(where, "vertex " + std::to_string(i) + " with a coordinate of " + metres(most),
                       "at most " + metres(kFarthestPoint) + " from the origin; is the scale right?");
    }
  }
  const double longest = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
  if (longest < kSmallestBody || longest > kLargestBody) {
    throw InputError(where, "a body whose longest side is " + metres(longest),
                     metres(kSmallestBody) + " to " + metres(kLargestBody) + "; is the scale right?");
  }
}

double tetrahedra_of(double volume, double edge) {
  return std::abs(volume) * 6.0 * std::sqrt(2.0) / (edge * edge * edge);
}

void check_edge_length(double edge, double longest_side, double volume, const std::string& where) {
  if (edge <= 0.0) return;
  const double least =
      std::max(kFinestEdge * longest_side, edge * std::cbrt(tetrahedra_of(volume, edge) / kMostTetrahedra));
  if (edge >= least) return;
  throw InputError(where, "max_edge_length: " + metres(edge),
                   "at least " + metres(least) + " for a body of " + metres(longest_side));
}

}  // namespace tissue_stiffness
