#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/effects/registry.hpp"
#include "tissue_stiffness/fem/discretisation.hpp"
#include "tissue_stiffness/fem/relaxation.hpp"
#include "tissue_stiffness/fem/vector_pool.hpp"
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

/// A number that the model file declares, and by how much it may be off.
struct UncertainConstant {
  std::string name;  ///< label.parameter
  int index = 0;     ///< in theta
  double value = 0.0;
  double std = 0.0;  ///< its tolerance, 1 sigma [the parameter's unit]
};

/// The sum of effects on a mesh: M a + C v + K u + relaxing and nonlinear forces = loads. Parameters come as theta, the
/// values of every parameter of every effect in order, initial velocity last.
class Model {
 public:
  /// Throws InputError for effects or regions that do not fit.
  Model(const ModelSettings& settings, const TetMesh& mesh);
  /// With the regions' parts of the mesh as given, whatever shapes the settings have for them.
  Model(const ModelSettings& settings, const TetMesh& mesh, std::map<std::string, Region> regions);
  /// Of a relative's mesh and regions; the body, and what both models have in common of it, they share.
  Model(const ModelSettings& settings, const Model& relative);
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const TetMesh& mesh() const { return body_->mesh; }
  const Discretisation& fem() const { return body_->fem; }
  /// Displacement of the body before anything moves it: 3n zeros.
  const Eigen::VectorXd& rest() const { return rest_; }
  const std::map<std::string, Region>& regions() const { return body_->regions; }
  const std::vector<FreeParameter>& free_parameters() const { return free_; }
  /// Declared numbers with a tolerance.
  const std::vector<UncertainConstant>& uncertain_constants() const { return constants_; }
  const std::vector<LoadInput>& load_inputs() const { return inputs_; }
  CourseTable& courses() { return courses_; }
  const CourseTable& courses() const { return courses_; }
  bool nonlinear() const { return nonlinear_; }
  const ModelSettings& settings() const { return settings_; }

  /// Time of the recording's first stamp [s]: courses from files and rhythms count from it. 0 until it is set.
  void set_first_stamp(double time);
  /// The same, and the loads of a whole recording; those of topics that nothing listens to are left out.
  void drive(double first_stamp, const std::vector<LoadSample>& loads);
  double first_stamp() const { return first_stamp_; }

  /// A flag a degree of freedom: held at rest by a `fixed` effect; and held at theta, when some of them give way there.
  const std::vector<char>& fixed() const { return fixed_; }
  std::vector<char> fixed(const Eigen::VectorXd& theta) const;

  /// theta for the filter's coordinates w; values are clamped to the parameters' bounds.
  Eigen::VectorXd theta(const Eigen::VectorXd& w) const;
  /// Prior in the filter's coordinates.
  Eigen::VectorXd prior_mean() const;
  /// Free parameters in their own units, by name; w: filter coordinates.
  std::map<std::string, double> values(const Eigen::VectorXd& w) const;
  /// `w` with the free parameters that `values` names where it has them.
  Eigen::VectorXd coordinates(const std::map<std::string, double>& values, Eigen::VectorXd w) const;
  Eigen::VectorXd prior_std() const;
  /// By how much each coordinate may have changed after a second, 1 sigma; 0 for what is constant.
  Eigen::VectorXd drift() const;
  /// Replaces the prior of the initial velocity (`initial: {velocity: from_frames}`), mean and std [m/s].
  void set_velocity_prior(const Eigen::Vector3d& mean, double std);
  /// From here on no parameter is free: all are as theta has them.
  void know(const Eigen::VectorXd& theta);
  /// Back to the prior before any frame.
  void forget_velocity_prior();

  Eigen::Vector3d initial_velocity(const Eigen::VectorXd& theta) const { return theta.tail<3>(); }

  /// Matrices at theta. `stiffness` holds the part that is linear, `reference_stiffness` every law's rest stiffness.
  SparseMatrix mass(const Eigen::VectorXd& theta) const;
  SparseMatrix stiffness(const Eigen::VectorXd& theta) const;
  SparseMatrix reference_stiffness(const Eigen::VectorXd& theta) const;
  /// Rayleigh coefficients: C = alpha M + beta K_reference; branches of K_reference that relax, those of modulus 0 left
  /// out.
  double mass_damping(const Eigen::VectorXd& theta) const;
  double stiffness_damping(const Eigen::VectorXd& theta) const;
  /// What moves has the mass M + gamma K_reference [s^2]; gravity and alpha act on M alone.
  double stiffness_inertia(const Eigen::VectorXd& theta) const;
  std::vector<Relaxation> relaxations(const Eigen::VectorXd& theta) const;
  Eigen::Vector3d body_acceleration(const Eigen::VectorXd& theta) const;
  /// What every mass, and what every measured load, is multiplied by.
  double mass_factor(const Eigen::VectorXd& theta) const;
  double load_factor(const Eigen::VectorXd& theta) const;

  /// A load moves the body alike at both, and it is seen as soon: they differ in what acts on it, or in a sensor, at most.
  bool same_answer(const Eigen::VectorXd& theta, const Eigen::VectorXd& other) const;

  /// What the forces at theta need of it at every instant.
  struct Point {
    struct Part {
      Eigen::VectorXd parameters;
      double finite_share;
      std::vector<Eigen::VectorXd> shaped;  ///< pattern of each load term, empty where that is constant
    };
    std::vector<Part> parts;
    double load_factor;
  };
  Point point(const Eigen::VectorXd& theta) const;
  /// Sum of the load terms (not gravity) at an instant [N].
  void add_loads(const Point& at, double time, Eigen::VectorXd& force) const;
  void add_nonlinear_force(const Point& at, Motion motion, Eigen::VectorXd& force) const;
  void add_nonlinear_stiffness(const Point& at, Motion motion, SparseMatrix& stiffness) const;
  /// Some force depends on the velocity beyond the damping; how.
  bool rubs(const Point& at) const;
  void add_friction(const Point& at, const Motion& motion, SparseMatrix& damping) const;
  /// Elastic and contact energy [J].
  double stored_energy(const Point& at, Motion motion) const;

  /// Some effect is one of the observation.
  bool observes() const;
  /// How late measurements are stamped [s], and what a sensor makes of the motion `since` seconds after the start.
  double delay(const Eigen::VectorXd& theta) const;
  ObservedMotion observe(const Eigen::VectorXd& theta, double since,
                         const Eigen::Ref<const Eigen::VectorXd>& displacement) const;

  /// One effect in the model: its terms and where its parameters stand in theta.
  struct Part {
    std::string label;
    std::shared_ptr<const Effect> effect;
    std::vector<int> indices;  ///< of its parameters in theta
    LinearTerms terms;
    Eigen::VectorXd parameters(const Eigen::VectorXd& theta) const;
  };
  const std::vector<Part>& parts() const { return parts_; }
  /// True when one of these parameters (indices of the part's) is estimated.
  bool estimated(const Part& part, const std::vector<int>& shape) const;
  /// True when any of its own parameters is.
  bool estimated(const Part& part) const;
  /// Value of a load term over time: measured, by a rhythm, or 1; the load factor included.
  double load_value(const LoadTerm& term, const Eigen::VectorXd& parameters, double load_factor, double time) const;
  /// Share of finite strain in a part's force, 0 to 1.
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
  std::vector<int> free_index_;  ///< of each free parameter in theta
  Eigen::VectorXd known_;        ///< theta with free parameters at their prior
  std::vector<int> holders_;     ///< how many `fixed` effects hold each node
  std::vector<char> fixed_;
  double first_stamp_ = 0.0;
  bool finite_law_ = false;  ///< the elasticity's law is one of finite strain
  bool nonlinear_ = false;
  mutable VectorPool scratch_;  ///< for forces of finite strain that only count in part
};

}  // namespace tissue_stiffness
