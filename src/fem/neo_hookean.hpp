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

/// Derivative of a stress P with respect to F, both by columns: entry (i + 3 J, k + 3 L) is dP_iJ / dF_kL [Pa].
using StressTangent = Eigen::Matrix<double, 9, 9>;

/// Returns the energy density of the solid below at one point [Pa], its first Piola-Kirchhoff stress P = mu (F - F^-T) +
/// lambda ln J F^-T, and the stress's derivative (Bonet & Wood 2008, eq. 6.28, 6.29, 6.30). All throw NumericalError unless
/// det F is positive.
double neo_hookean_energy(const Lame& lame, const Eigen::Matrix3d& f);
Eigen::Matrix3d neo_hookean_stress(const Lame& lame, const Eigen::Matrix3d& f);
StressTangent neo_hookean_tangent(const Lame& lame, const Eigen::Matrix3d& f);
/// Returns P = F (lambda tr(E') I + 2 mu E') of the strain rate E' = sym(F^T F') at one point, and dP / dF'.
Eigen::Matrix3d viscous_stress(const Lame& viscosity, const Eigen::Matrix3d& f, const Eigen::Matrix3d& rate);
StressTangent viscous_tangent(const Lame& viscosity, const Eigen::Matrix3d& f);

/// Factor of the moduli at a quadrature point.
using PointShare = std::function<double(int e, int q)>;

/// Compressible neo-Hookean solid over the listed elements, psi = mu/2 (tr F^T F - 3 - 2 ln J) + lambda/2 (ln J)^2 (Bonet &
/// Wood 2008, eq. 6.28). All functions throw NumericalError naming an element that is turned inside out.
class NeoHookean {
 public:
  NeoHookean(const Discretisation& fem, std::vector<int> elements);

  /// Subtracts the internal force [N] at displacement u (3n) from `force`.
  void add_force(const Lame& lame, const Eigen::VectorXd& u, Eigen::VectorXd& force) const;
  /// Adds the tangent stiffness [N/m].
  void add_stiffness(const Lame& lame, const Eigen::VectorXd& u, SparseMatrix& stiffness) const;
  /// Returns the stored energy [J].
  double energy(const Lame& lame, const Eigen::VectorXd& u) const;

  /// Subtracts the force [N] of a stress that is linear in a strain given at all quadrature points (see green_strains),
  /// with these moduli and a `share` of them, and adds its tangent for a strain sym(F^T grad w),
  ///   P = F S,  S = share (lambda tr(E) I + 2 mu E).
  /// With the rate of Green's strain and viscosities for moduli this is Kelvin-Voigt's stress (Holzapfel 2000, sec. 6.9).
  /// A turning body turns the force. At u = 0 both are those of the linear stiffness.
  void add_strain_force(const Lame& lame, const Eigen::VectorXd& u, const Eigen::Ref<const Eigen::VectorXd>& strains,
                        const PointShare& share, Eigen::VectorXd& force) const;
  void add_strain_tangent(const Lame& lame, const Eigen::VectorXd& u, const PointShare& share,
                          SparseMatrix& stiffness) const;

 private:
  template <int N>
  void force(const Lame& lame, const Eigen::VectorXd& u, Eigen::VectorXd& f) const;
  template <int N>
  void strain_force(const Lame& lame, const Eigen::VectorXd& u, const Eigen::Ref<const Eigen::VectorXd>& strains,
                    const PointShare& share, Eigen::VectorXd& f) const;

  const Discretisation& fem_;
  std::vector<int> elements_;
  NodeCorners corners_;                  ///< corners of each node, for its parts of the elements' forces
  std::unique_ptr<VectorPool> scratch_;  ///< buffers for these parts, one for each concurrent sum
};

}  // namespace tissue_stiffness
