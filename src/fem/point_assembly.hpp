#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <mutex>

#include "fem/discretisation.hpp"
#include "fem/neo_hookean.hpp"

namespace tissue_stiffness {

/// Adds a first Piola-Kirchhoff stress P(F) [Pa] at quadrature point q of element e, and its derivative.
using PointStress = std::function<void(int e, int q, const Eigen::Matrix3d& f, Eigen::Matrix3d& stress)>;
using PointTangent = std::function<void(int e, int q, const Eigen::Matrix3d& f, StressTangent& tangent)>;
/// Returns the energy density psi(F) there [Pa].
using PointEnergy = std::function<double(int e, int q, const Eigen::Matrix3d& f)>;

/// Sums over all quadrature points of a law that is given at one point (Bonet & Wood 2008, eq. 9.15, 9.31). All functions
/// throw NumericalError naming an element that is turned inside out.
class PointAssembly {
 public:
  explicit PointAssembly(const Discretisation& fem);
  ~PointAssembly();

  /// Subtracts the internal force int P grad N dV [N] at displacement u (3n) from `force`.
  void add_force(const PointStress& stress, const Eigen::VectorXd& u, Eigen::VectorXd& force) const;
  /// Adds the tangent stiffness int grad N dP/dF grad N dV [N/m].
  void add_stiffness(const PointTangent& tangent, const Eigen::VectorXd& u, SparseMatrix& stiffness) const;
  /// Returns the stored energy int psi dV [J].
  double energy(const PointEnergy& density, const Eigen::VectorXd& u) const;

 private:
  /// What sums of forces need. Effects of small strain never ask for one, so it is made with the first.
  struct Sums;
  Sums& sums() const;

  const Discretisation& fem_;
  mutable std::once_flag made_;
  mutable std::unique_ptr<Sums> sums_;
};

}  // namespace tissue_stiffness
