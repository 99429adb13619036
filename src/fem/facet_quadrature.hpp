#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/discretisation.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Positions of a facet's nodes, 3 x 3 or 3 x 6 [m].
using FacetNodes = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6>;

/// Shape functions of 3- or 6-node facets at the points of a triangle rule, for surface loads. The rule has 3 points of
/// degree 2 for 3 nodes, and 6 points of degree 4 for 6 nodes (Dunavant 1985). A composite rule divides each edge of the
/// triangle into `divisions` parts and has these points in each part.
class FacetQuadrature {
 public:
  explicit FacetQuadrature(int nodes_per_facet, int divisions = 1);

  int points() const { return static_cast<int>(weights_.size()); }
  double weight(int q) const { return weights_[q]; }  ///< weights of the unit triangle; they sum to 1/2
  auto shape(int q) const { return shape_.col(q); }   ///< one value a node
  const Eigen::MatrixX2d& derivative(int q) const { return derivatives_[static_cast<std::size_t>(q)]; }  ///< nodes x 2

  /// Returns the area-scaled outward normal dx/dr x dx/ds at point q [m^2]. |n| w sums to the area.
  Eigen::Vector3d normal(const FacetNodes& x, int q) const;

 private:
  Eigen::VectorXd weights_;
  Eigen::MatrixXd shape_;
  std::vector<Eigen::MatrixX2d> derivatives_;
};

/// Returns the positions of a facet's nodes; `displacement` (3n) may be null.
FacetNodes facet_nodes(const TetMesh& mesh, int facet, const Eigen::VectorXd* displacement = nullptr);

/// Computes int N_a N_b dA over facets. The matrix is 3n x 3n with a 3 x 3 identity block for each pair of nodes, and
/// stores only its own non-zeros [m^2].
SparseMatrix facet_mass(const TetMesh& mesh, const std::vector<int>& facets);

/// Returns the local number of each of a facet's nodes in its tetrahedron, for Discretisation::add_block.
std::vector<int> facet_local_nodes(const TetMesh& mesh, int facet);

/// Computes int N_a dA / A over facets, one number for each node of the mesh. This is the nodal share of an evenly
/// distributed force.
Eigen::VectorXd facet_mean(const TetMesh& mesh, const std::vector<int>& facets);

/// Returns the 3n vector whose component `axis` (0, 1, 2) of node a is weights[a]. The other components are 0.
Eigen::VectorXd along_axis(const Eigen::VectorXd& weights, int axis);

/// Returns the sum of nodal forces (3n).
Eigen::Vector3d resultant(const Eigen::VectorXd& forces);

}  // namespace tissue_stiffness
