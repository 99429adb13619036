#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "fem/discretisation.hpp"
#include "fem/node_corners.hpp"
#include "fem/vector_pool.hpp"

namespace tissue_stiffness {

/// Lame parameters [Pa].
struct Lame {
  double lambda;
  double mu;
};

/// Computes lambda = E nu / ((1 + nu)(1 - 2 nu)), mu = E / (2 (1 + nu)).
inline Lame lame(double young_modulus, double poisson_ratio) {
  return {young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio)),
          young_modulus / (2.0 * (1.0 + poisson_ratio))};
}

/// Factor of the stress at a quadrature point, and its derivative with respect to the energy density psi [1/Pa].
struct StressScale {
  double value = 1.0;
  double slope = 0.0;
};
using PointLaw = std::function<StressScale(int e, int q, double psi)>;

/// Compressible neo-Hookean solid over the listed elements, psi = mu/2 (tr F^T F - 3 - 2 ln J) + lambda/2 (ln J)^2 (Bonet &
/// Wood 2008, eq. 6.28). All functions throw NumericalError naming an element that is turned inside out.
class NeoHookean {
 public:
  NeoHookean(const Discretisation& fem, std::vector<int> elements);

  /// Subtracts the internal force [N] at displacement u (3n) from `force`.
  void add_force(const Lame& lame, const Eigen::VectorXd& u, Eigen::VectorXd& force) const;
  /// Adds the tangent stiffness [N/m].
  void add_stiffness(const Lame& lame, const Eigen::VectorXd& u, SparseMatrix& stiffness) const;
  /// These do so with the stress P(F) scaled at each point: scale(e, q, psi).value P.
  void add_force(const Lame& lame, const Eigen::VectorXd& u, const PointLaw& scale, Eigen::VectorXd& force) const;
  void add_stiffness(const Lame& lame, const Eigen::VectorXd& u, const PointLaw& scale, SparseMatrix& stiffness) const;
  /// Returns the stored energy [J].
  double energy(const Lame& lame, const Eigen::VectorXd& u) const;

 private:
  template <int N, typename Law>
  void force(const Lame& lame, const Eigen::VectorXd& u, const Law& law, Eigen::VectorXd& f) const;

  const Discretisation& fem_;
  std::vector<int> elements_;
  NodeCorners corners_;                  ///< corners of each node, for its parts of the elements' forces
  std::unique_ptr<VectorPool> scratch_;  ///< buffers for these parts, one for each concurrent sum
};

}  // namespace tissue_stiffness
