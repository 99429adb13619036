#pragma once

#include <Eigen/Core>
#include <vector>

#include "effects/effect.hpp"
#include "fem/facet_quadrature.hpp"

namespace tissue_stiffness::effects {

/// A surface under a pressure p that acts on the tissue. Its nodal forces are -p int N_a n dA, where n is the outward
/// normal (Bonet & Wood 2008, sec. 8.5.2).
class PressedSurface {
 public:
  /// `region`: facets of the mesh. Throws InputError for a region without facets.
  PressedSurface(const Value& region, const EffectContext& context);

  /// Adds the force [N] of `pressure` [Pa] on the surface at rest, or displaced by u [m] if u is not null.
  void add_force(const Eigen::VectorXd* u, double pressure, Eigen::VectorXd& force) const;
  /// Adds the symmetric part of -d force / d u, which is exact except at the edge of the surface.
  void add_stiffness(const Eigen::VectorXd& u, double pressure, SparseMatrix& stiffness) const;
  /// Returns the force of a unit pressure on the surface at rest [N/Pa].
  Eigen::VectorXd unit_force() const;

 private:
  void add_facet_stiffness(std::size_t i, const Eigen::VectorXd& u, double pressure, SparseMatrix& stiffness) const;

  const TetMesh& mesh_;
  const Discretisation& fem_;
  std::vector<int> facets_;
  std::vector<std::vector<int>> local_;
  FacetQuadrature rule_;
};

}  // namespace tissue_stiffness::effects
