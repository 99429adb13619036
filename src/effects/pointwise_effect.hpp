#pragma once

#include "effects/effect.hpp"
#include "fem/point_assembly.hpp"

namespace tissue_stiffness {

/// An effect whose law under finite strain is given by an energy density psi(F) at a point, with its stress and tangent
/// (PointForm). It sums them over the body.
class PointwiseEffect : public Effect, public FiniteStrainForm, public PointForm {
 public:
  explicit PointwiseEffect(const Discretisation& fem) : points_(fem) {}

  const FiniteStrainForm* finite_strain() const final { return this; }
  const PointForm* point_form() const final { return this; }
  void add_finite_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const final {
    if (is_absent(p)) return;
    const auto stress = [this, &p](int e, int q, const Eigen::Matrix3d& f, Eigen::Matrix3d& out) {
      add_stress(e, q, f, p, out);
    };
    points_.add_force(stress, motion.displacement, force);
  }
  void add_finite_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const final {
    if (is_absent(p)) return;
    const auto tangent = [this, &p](int e, int q, const Eigen::Matrix3d& f, StressTangent& out) {
      add_tangent(e, q, f, p, out);
    };
    points_.add_stiffness(tangent, motion.displacement, stiffness);
  }
  /// Returns the energy of finite strain. That of small strain is left out.
  double energy(const Motion& motion, const Parameters& p) const override {
    if (motion.finite_share == 0.0 || is_absent(p)) return 0.0;
    const auto density = [this, &p](int e, int q, const Eigen::Matrix3d& f) { return energy_density(e, q, f, p); };
    return motion.finite_share * points_.energy(density, motion.displacement);
  }

 private:
  /// Returns whether the law has no stress anywhere.
  virtual bool is_absent(const Parameters& p) const = 0;
  /// Returns psi(F) [Pa].
  virtual double energy_density(int e, int q, const Eigen::Matrix3d& f, const Parameters& p) const = 0;

  PointAssembly points_;
};

}  // namespace tissue_stiffness
