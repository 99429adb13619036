#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "effects/effect.hpp"
#include "fem/discretisation.hpp"
#include "fem/relaxation.hpp"
#include "fem/vector_pool.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// One unknown of the model file. The filter uses w = log(value) where the prior is log-normal, and the value otherwise.
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

/// A number that the model file declares, with its uncertainty.
struct UncertainConstant {
  std::string name;  ///< label.parameter
  int index = 0;     ///< in theta
  double value = 0.0;
  double std = 0.0;  ///< tolerance, 1 sigma [the parameter's unit]
};

/// The sum of effects on a mesh: M a + C v + K u + relaxing and nonlinear forces = loads. The vector theta holds the values
/// of every parameter of every effect in order, and then the initial velocity.
class Model {
 public:
  /// Builds the model. Throws InputError for effects or regions that do not fit.
  Model(const ModelSettings& settings, const TetMesh& mesh);
  /// Builds the model with given regions, whatever shapes the settings have for them.
  Model(const ModelSettings& settings, const TetMesh& mesh, std::map<std::string, Region> regions);
  /// Builds the model on the mesh and regions of a relative. Both share the body and the effects that they have in common.
  Model(const ModelSettings& settings, const Model& relative);
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const TetMesh& mesh() const { return body_->mesh; }
  const Discretisation& fem() const { return body_->fem; }
  /// Returns the displacement of the body before anything moves it: 3n zeros.
  const Eigen::VectorXd& rest() const { return rest_; }
  const std::map<std::string, Region>& regions() const { return body_->regions; }
  const std::vector<FreeParameter>& free_parameters() const { return free_; }
  /// Returns the declared numbers that have a tolerance.
  const std::vector<UncertainConstant>& uncertain_constants() const { return constants_; }
  const std::vector<LoadInput>& load_inputs() const { return inputs_; }
  CourseTable& courses() { return courses_; }
  const CourseTable& courses() const { return courses_; }
  bool nonlinear() const { return nonlinear_; }
  const ModelSettings& settings() const { return settings_; }

  /// Sets the time of the recording's first stamp [s]. Courses from files and rhythms count from it. It is 0 until it is
  /// set.
  void set_first_stamp(double time);
  /// Sets the first stamp and adds the loads of a whole recording. Loads of topics that the model does not use are skipped.
  void drive(double first_stamp, const std::vector<LoadSample>& loads);
  double first_stamp() const { return first_stamp_; }

  /// These return a flag for each degree of freedom. The first tells whether a `fixed` effect holds it at rest. The second
  /// tells whether it is held at theta, where some of these supports may be compliant.
  const std::vector<char>& fixed() const { return fixed_; }
  std::vector<char> fixed(const Eigen::VectorXd& theta) const;

  /// Returns theta for the filter's coordinates w. Values are clamped to the parameters' bounds.
  Eigen::VectorXd theta(const Eigen::VectorXd& w) const;
  /// Returns the prior mean in the filter's coordinates.
  Eigen::VectorXd prior_mean() const;
  /// Returns the free parameters in their own units, by name; w: filter coordinates.
  std::map<std::string, double> values(const Eigen::VectorXd& w) const;
  /// Returns `w` with the free parameters that are named in `values` set to their values there.
  Eigen::VectorXd coordinates(const std::map<std::string, double>& values, Eigen::VectorXd w) const;
  Eigen::VectorXd prior_std() const;
  /// Returns the change of each coordinate after one second, 1 sigma; 0 if it is constant.
  Eigen::VectorXd drift() const;
  /// Replaces the prior of the initial velocity (`initial: {velocity: from_frames}`), mean and std [m/s].
  void set_velocity_prior(const Eigen::Vector3d& mean, double std);
  /// Fixes all parameters at theta; from now on none is free.
  void know(const Eigen::VectorXd& theta);
  /// Restores the prior of the initial velocity before any frame.
  void forget_velocity_prior();

  Eigen::Vector3d initial_velocity(const Eigen::VectorXd& theta) const { return theta.tail<3>(); }

  /// These return the matrices at theta. `stiffness` holds the linear part, `reference_stiffness` the rest stiffness of
  /// every law.
  SparseMatrix mass(const Eigen::VectorXd& theta) const;
  SparseMatrix stiffness(const Eigen::VectorXd& theta) const;
  SparseMatrix reference_stiffness(const Eigen::VectorXd& theta) const;
  /// Rayleigh coefficients in C = alpha M + beta K_reference.
  double mass_damping(const Eigen::VectorXd& theta) const;
  double stiffness_damping(const Eigen::VectorXd& theta) const;
  /// Returns gamma in the mass M + gamma K_reference of the moving body [s^2]; gravity and alpha act on M alone. The
  /// relaxing branches of K_reference follow, without those of modulus 0.
  double stiffness_inertia(const Eigen::VectorXd& theta) const;
  std::vector<Relaxation> relaxations(const Eigen::VectorXd& theta) const;
  Eigen::Vector3d body_acceleration(const Eigen::VectorXd& theta) const;
  /// These return the factor of every mass, and that of every measured load.
  double mass_factor(const Eigen::VectorXd& theta) const;
  double load_factor(const Eigen::VectorXd& theta) const;

  /// Returns whether the body responds to a load alike at both theta, with equal delays of the measurements. They may then
  /// differ only in what acts on the body, or in a sensor.
  bool same_answer(const Eigen::VectorXd& theta, const Eigen::VectorXd& other) const;

  /// Values that depend on theta and that the forces need at every instant.
  struct Point {
    struct Part {
      Eigen::VectorXd parameters;
      double finite_share;
      std::vector<Eigen::VectorXd> shaped;  ///< pattern of each load term; empty if it is constant
    };
    std::vector<Part> parts;
    double load_factor;
  };
  Point point(const Eigen::VectorXd& theta) const;
  /// Adds the load terms (without gravity) at an instant [N].
  void add_loads(const Point& at, double time, Eigen::VectorXd& force) const;
  void add_nonlinear_force(const Point& at, Motion motion, Eigen::VectorXd& force) const;
  void add_nonlinear_stiffness(const Point& at, Motion motion, SparseMatrix& stiffness) const;
  /// Returns whether a force depends on the velocity beyond the damping. The next function adds its tangent.
  bool has_velocity_tangent(const Point& at) const;
  void add_velocity_tangent(const Point& at, const Motion& motion, SparseMatrix& damping) const;
  /// Returns elastic and contact energy [J].
  double stored_energy(const Point& at, Motion motion) const;

  /// Returns whether some effect belongs to the observation.
  bool observes() const;
  /// The first returns the delay of the measurements' stamps [s]. The second returns the motion as a sensor observes it
  /// `since` seconds after the start.
  double delay(const Eigen::VectorXd& theta) const;
  ObservedMotion observe(const Eigen::VectorXd& theta, double since,
                         const Eigen::Ref<const Eigen::VectorXd>& displacement) const;

  /// One effect in the model, with its terms and the positions of its parameters in theta.
  struct Part {
    std::string label;
    std::shared_ptr<const Effect> effect;
    std::vector<int> indices;  ///< indices of its parameters in theta
    LinearTerms terms;
    Eigen::VectorXd parameters(const Eigen::VectorXd& theta) const;
  };
  const std::vector<Part>& parts() const { return parts_; }
  /// Returns whether one of these parameters (indices of the part's) is estimated.
  bool estimated(const Part& part, const std::vector<int>& shape) const;
  /// Returns whether any of its own parameters is estimated.
  bool estimated(const Part& part) const;
  /// Returns the value of a load term at a time: measured, from a rhythm, or 1. A measured load includes `load_factor`.
  double load_value(const LoadTerm& term, const Eigen::VectorXd& parameters, double load_factor, double time) const;
  /// Returns the share of finite strain in a part's force, 0 to 1.
  double finite_share(const Part& part, const Eigen::VectorXd& theta) const;

 private:
  struct Body {
    Body(const TetMesh& of, std::map<std::string, Region> with) : mesh(of), fem(mesh), regions(std::move(with)) {}
    TetMesh mesh;
    Discretisation fem;
    std::map<std::string, Region> regions;
  };
  Model(const ModelSettings& settings, std::shared_ptr<const Body> body, const Model* relative);
  EffectContext context();
  void add_part(const EffectSettings& settings, const EffectContext& context, const Model* relative);
  std::shared_ptr<const Effect> shared_effect(const EffectSettings& settings) const;
  void add_parameters(const EffectSettings& settings, Part& part);
  void link_elasticities();
  void check_laws() const;
  void settle_terms(Part& part) const;
  void add_initial_velocity();
  SparseMatrix sum_stiffness(const Eigen::VectorXd& theta, bool reference) const;

  ModelSettings settings_;
  std::shared_ptr<const Body> body_;
  Eigen::VectorXd rest_;
  CourseTable courses_;
  std::vector<LoadInput> inputs_;
  std::vector<Part> parts_;
  std::vector<FreeParameter> free_;
  std::vector<UncertainConstant> constants_;
  std::vector<int> free_index_;        ///< index of each free parameter in theta
  Eigen::VectorXd known_;              ///< theta with the free parameters at their prior
  std::vector<int> constraint_count_;  ///< number of `fixed` effects that hold each node
  std::vector<char> fixed_;
  double first_stamp_ = 0.0;
  bool finite_law_ = false;  ///< the elasticity has a law of finite strain
  bool nonlinear_ = false;
  mutable VectorPool scratch_;  ///< for forces of finite strain that have a share below 1
};

}  // namespace tissue_stiffness
