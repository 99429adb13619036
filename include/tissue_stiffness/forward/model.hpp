#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/effects/registry.hpp"
#include "tissue_stiffness/fem/discretisation.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// One unknown of the model file. The filter works on w = log(value) where the prior is log-normal, on the value otherwise.
struct FreeParameter {
  std::string name;  ///< label.parameter
  std::string unit;
  Quantity prior;
  double lower = 0.0, upper = 0.0;  ///< allowed values

  double to_value(double w) const;
  double to_coordinate(double value) const;
  double prior_mean() const { return to_coordinate(prior.value); }
  double prior_std() const;
};

/// The sum of effects on a mesh: M a + C v + K u + nonlinear forces = loads. Parameters come as theta, the values of every
/// parameter of every effect in order, initial velocity last.
class Model {
 public:
  /// Throws InputError for effects or regions that do not fit.
  Model(const ModelSettings& settings, const TetMesh& mesh);
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const TetMesh& mesh() const { return mesh_; }
  const Discretisation& fem() const { return fem_; }
  const std::map<std::string, Region>& regions() const { return regions_; }
  const std::vector<FreeParameter>& free_parameters() const { return free_; }
  const std::vector<LoadInput>& load_inputs() const { return inputs_; }
  CourseTable& courses() { return courses_; }
  const std::vector<char>& fixed() const { return fixed_; }  ///< a flag a degree of freedom
  bool nonlinear() const { return nonlinear_; }
  const ModelSettings& settings() const { return settings_; }

  /// theta for the filter's coordinates w; values are clamped to the parameters' bounds.
  Eigen::VectorXd theta(const Eigen::VectorXd& w) const;
  /// Prior in the filter's coordinates.
  Eigen::VectorXd prior_mean() const;
  Eigen::VectorXd prior_std() const;
  /// Replaces the prior of the initial velocity (`initial: {velocity: from_frames}`), mean and std [m/s].
  void set_velocity_prior(const Eigen::Vector3d& mean, double std);
  /// Back to the prior before any frame.
  void forget_velocity_prior();

  Eigen::Vector3d initial_velocity(const Eigen::VectorXd& theta) const { return theta.tail<3>(); }

  /// Matrices at theta. `stiffness` leaves out laws that are not linear, `reference_stiffness` holds every law's rest
  /// stiffness.
  SparseMatrix mass(const Eigen::VectorXd& theta) const;
  SparseMatrix stiffness(const Eigen::VectorXd& theta) const;
  SparseMatrix reference_stiffness(const Eigen::VectorXd& theta) const;
  /// Rayleigh coefficients: C = alpha M + beta K_reference.
  double mass_damping(const Eigen::VectorXd& theta) const;
  double stiffness_damping(const Eigen::VectorXd& theta) const;
  Eigen::Vector3d body_acceleration(const Eigen::VectorXd& theta) const;

  /// Sum of the load terms (not gravity) at an instant [N].
  void add_loads(const Eigen::VectorXd& theta, double time, Eigen::VectorXd& force) const;
  void add_nonlinear_force(const Eigen::VectorXd& theta, const Motion& motion, Eigen::VectorXd& force) const;
  void add_nonlinear_stiffness(const Eigen::VectorXd& theta, const Motion& motion, SparseMatrix& stiffness) const;
  /// Elastic and contact energy [J].
  double stored_energy(const Eigen::VectorXd& theta, const Motion& motion) const;

  /// One effect in the model: its terms and where its parameters stand in theta.
  struct Part {
    std::string label;
    std::unique_ptr<Effect> effect;
    int offset = 0;
    int count = 0;
    LinearTerms terms;
    auto parameters(const Eigen::VectorXd& theta) const { return theta.segment(offset, count); }
  };
  const std::vector<Part>& parts() const { return parts_; }
  /// Coefficients of all parts' mass, stiffness and load terms at theta, in order of parts and terms.
  Eigen::VectorXd stiffness_coefficients(const Eigen::VectorXd& theta) const;

 private:
  void add_part(const EffectSettings& settings, const EffectContext& context);
  void add_initial_velocity();

  ModelSettings settings_;
  TetMesh mesh_;
  Discretisation fem_;
  std::map<std::string, Region> regions_;
  CourseTable courses_;
  std::vector<LoadInput> inputs_;
  std::vector<Part> parts_;
  std::vector<FreeParameter> free_;
  std::vector<int> free_index_;  ///< of each free parameter in theta
  Eigen::VectorXd known_;        ///< theta with free parameters at their prior
  std::vector<char> fixed_;
  bool nonlinear_ = false;
};

}  // namespace tissue_stiffness
