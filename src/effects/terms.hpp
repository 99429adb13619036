#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "effects/course.hpp"
#include "fem/discretisation.hpp"
#include "fem/strain.hpp"

namespace tissue_stiffness {

/// Values of the effect's own parameters, in the order of its spec, with the components of vectors. For an effect that
/// needs_elasticity(), modulus and Poisson's ratio of every elasticity of the model follow.
using Parameters = Eigen::Ref<const Eigen::VectorXd>;
using Coefficient = std::function<double(const Parameters&)>;

/// A contribution that is linear in displacement and velocity: coefficient(parameters) times a constant matrix.
struct MatrixTerm {
  std::shared_ptr<const SparseMatrix> matrix;  ///< 3n x 3n; a local term stores only its own non-zeros
  Coefficient coefficient;
  bool relaxes = true;  ///< of a stiffness: damping and relaxing branches act on it, too
};

/// Stiffness coefficient(p) int B^T R R^T B dV, whose integrand may depend on parameters (a place, an angle). It is never
/// stored in full: a reduced basis projects it again for each p.
struct StrainTerm {
  std::function<StrainFactor(int e, int q, const Parameters&)> factor;
  Coefficient coefficient;
  std::vector<int> shape;  ///< indices of the effect's parameters that `factor` depends on

  StrainFactorField at(const Eigen::VectorXd& p) const {
    return [this, p](int e, int q) { return factor(e, q, p); };
  }
};

/// Force coefficient(p) pattern(p) value(t).
struct LoadTerm {
  Eigen::VectorXd pattern;  ///< nodal forces of a unit load, 3n
  Coefficient coefficient;
  std::shared_ptr<const Course> course;  ///< a measured load; null: none
  int component = 0;                     ///< component of the course
  bool prescribed = false;  ///< the course is a displacement [m], which a spring of `pattern` imposes; it is no load
  std::function<double(double, const Parameters&)> activation;  ///< function of the time since the first stamp; null: 1
  std::function<Eigen::VectorXd(const Parameters&)> shaped;     ///< pattern for given parameters; null: it is constant
  std::vector<int> shape;                                       ///< indices of the parameters that `shaped` depends on

  /// Returns the load's value. `now` is absolute, `since` counts from the recording's first stamp [s].
  double value(double now, double since, const Parameters& p) const {
    if (course) return course->value(now, component);
    return activation ? activation(since, p) : 1.0;
  }
};

/// A branch of the standard linear solid that acts on the whole stiffness at rest.
struct RelaxationTerm {
  Coefficient modulus;
  Coefficient time_constant;
};

/// How the body starts: the share of its static equilibrium under the first loads, and the amplitudes of six smooth motions
/// (ReducedModel::start_shapes).
struct InitialMotion {
  double equilibrium = 0.0;                                                        ///< [-]
  Eigen::Matrix<double, 6, 1> displacement = Eigen::Matrix<double, 6, 1>::Zero();  ///< [m]
  Eigen::Matrix<double, 6, 1> velocity = Eigen::Matrix<double, 6, 1>::Zero();      ///< [m/s]

  bool none() const { return equilibrium == 0.0 && displacement.isZero(0.0) && velocity.isZero(0.0); }
};

struct LinearTerms {
  std::vector<MatrixTerm> mass;                ///< [kg]
  std::vector<MatrixTerm> stiffness;           ///< [N/m], symmetric
  std::vector<StrainTerm> strain_stiffness;    ///< [N/m]
  std::vector<LoadTerm> loads;                 ///< [N]
  std::vector<Coefficient> acceleration[3];    ///< body acceleration [m/s^2]; its force is the whole mass matrix times it
  std::vector<Coefficient> mass_damping;       ///< alpha [1/s]
  std::vector<Coefficient> stiffness_damping;  ///< beta [s]
  std::vector<Coefficient> stiffness_inertia;  ///< factor of a mass proportional to the stiffness at rest [s^2]
  std::vector<RelaxationTerm> relaxation;
  std::vector<Coefficient> mass_factor;   ///< factors of every mass
  std::vector<Coefficient> load_factor;   ///< factors of every measured load
  std::vector<Coefficient> finite_share;  ///< share of finite strain, 0 to 1; the rest is small strain
  /// Region whose motion is prescribed; empty: none. Its stiffness terms do not relax and pull it to where its prescribed
  /// loads want it. Together they are the whole force on it.
  std::string guided_region;
  std::function<InitialMotion(const Parameters&)> initial_motion;  ///< null: undeformed and at rest
};

}  // namespace tissue_stiffness
