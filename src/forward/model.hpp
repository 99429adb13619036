#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "effects/effect.hpp"
#include "fem/relaxation.hpp"
#include "fem/vector_pool.hpp"
#include "forward/body.hpp"
#include "forward/loads.hpp"
#include "forward/model_part.hpp"
#include "forward/parameter_space.hpp"
#include "forward/sensors.hpp"

namespace tissue_stiffness {

/// The sum of effects on a body: M a + C v + K u + relaxing and nonlinear forces = loads. All of it is a function of theta,
/// the values of the parameter space.
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
  /// A region whose motion is prescribed, or that a tool touches. The force on it is a reaction of the body.
  struct Reaction {
    std::size_t part;  ///< index of the effect that prescribes the motion, or touches
    std::string region;
    /// Force of its springs when the body moves by a unit along each axis, 3n x 3 [N/m]; zero where a tool touches.
    Eigen::MatrixX3d springs;
  };
  const std::vector<Reaction>& reactions() const { return reactions_; }
  /// Returns the number of rows that a run shows of an instant: the displacement of every node, 3n [m], and then each
  /// reaction, 3 rows [N].
  Eigen::Index output_size() const { return rest_.size(); }
  /// Returns what a run shows of the body before anything moves it: zeros.
  const Eigen::VectorXd& rest() const { return rest_; }
  const Body& body() const { return *body_; }
  const ModelSettings& settings() const { return settings_; }
  const ParameterSpace& parameters() const { return parameters_; }
  ParameterSpace& parameters() { return parameters_; }
  const Loads& loads() const { return loads_; }
  Loads& loads() { return loads_; }
  const Sensors& sensors() const { return sensors_; }
  bool nonlinear() const { return nonlinear_; }

  /// These return a flag for each degree of freedom. The first tells whether a `fixed` effect holds it at rest. The second
  /// tells whether it is held at theta, where some of these supports may be compliant.
  const std::vector<char>& fixed() const { return fixed_; }
  std::vector<char> fixed(const Eigen::VectorXd& theta) const;

  /// Fixes all parameters at theta; from now on none is free.
  void know(const Eigen::VectorXd& theta);

  Eigen::Vector3d initial_velocity(const Eigen::VectorXd& theta) const { return theta.tail<3>(); }
  /// Returns whether the body starts, or may start, loaded or in motion, and the sum of what the effects say of it at
  /// theta.
  bool starts_in_motion() const;
  InitialMotion initial_motion(const Eigen::VectorXd& theta) const;
  /// Returns theta at the prior of the model file. It stays the same where `know` changes what is known.
  const Eigen::VectorXd& prior_theta() const { return prior_theta_; }

  /// These return the matrices at theta. `stiffness` holds the linear part, `rest_stiffness` that of the body at rest,
  /// `reference_stiffness` the same without springs that do not relax.
  SparseMatrix mass(const Eigen::VectorXd& theta) const;
  SparseMatrix stiffness(const Eigen::VectorXd& theta) const;
  SparseMatrix rest_stiffness(const Eigen::VectorXd& theta) const;
  SparseMatrix reference_stiffness(const Eigen::VectorXd& theta) const;
  /// Returns what of the reference stiffness damps and relaxes linearly. It lacks the share that acts through strain.
  SparseMatrix linear_reference_stiffness(const Eigen::VectorXd& theta) const;
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
      /// Returns whether what shapes its forces is the same.
      bool same(const Part& other) const { return parameters == other.parameters && finite_share == other.finite_share; }
    };
    std::vector<Part> parts;
    double load_factor;
    double stiffness_damping;  ///< beta [s]
  };
  Point point(const Eigen::VectorXd& theta) const;
  /// Adds the load terms (without gravity) at an instant [N].
  void add_loads(const Point& at, double time, Eigen::VectorXd& force) const;
  void add_nonlinear_force(const Point& at, Motion motion, Eigen::VectorXd& force) const;
  /// Returns whether the nonlinear forces of a part differ between two theta, but for their viscous stress.
  bool nonlinear_part_changes(const Point& from, const Point& to, std::size_t part) const;
  /// Adds what the nonlinear forces change by between two theta. Parts that stay the same are not evaluated.
  void add_nonlinear_change(const Point& from, const Point& to, Motion motion, Eigen::VectorXd& force) const;
  void add_nonlinear_stiffness(const Point& at, Motion motion, SparseMatrix& stiffness) const;
  /// Returns whether a force depends on the velocity beyond the linear damping: friction, or the viscous stress of finite
  /// strain. The next function adds their tangents.
  bool has_friction(const Point& at) const;
  bool has_finite_damping(const Point& at) const;
  /// Returns whether some law has its stress in finite strain at some theta.
  bool may_be_finite() const;
  bool always_finite() const { return finite_law_; }
  /// Returns whether an effect makes damping or mass in proportion to the stiffness at rest.
  bool may_damp_by_stiffness() const;
  /// Adds the force [N] of a stress linear in `strains`, of all laws under finite strain, times their share of it.
  void add_strain_force(const Point& at, const Eigen::VectorXd& u, const Eigen::Ref<const Eigen::VectorXd>& strains,
                        Eigen::VectorXd& force) const;
  void add_velocity_tangent(const Point& at, Motion motion, SparseMatrix& damping) const;
  /// Computes the reactions [N] to prescribed motions and tools, 3 rows each, at an instant of a run.
  void find_reactions(const Point& at, const Motion& motion, Eigen::Ref<Eigen::VectorXd> out) const;
  /// Returns elastic and contact energy [J].
  double stored_energy(const Point& at, Motion motion) const;

  using Part = ModelPart;
  const std::vector<Part>& parts() const { return parts_; }
  /// Returns whether one of these parameters (indices of the part's) is estimated.
  bool estimated(const Part& part, const std::vector<int>& shape) const;
  /// Returns whether any of its own parameters is estimated.
  bool estimated(const Part& part) const;
  /// Returns the share of finite strain in a part's force, 0 to 1.
  double finite_share(const Part& part, const Eigen::VectorXd& theta) const;

 private:
  Model(const ModelSettings& settings, std::shared_ptr<const Body> body, const Model* relative);
  EffectContext context();
  void add_part(const EffectSettings& settings, const EffectContext& context, const Model* relative);
  std::shared_ptr<const Effect> shared_effect(const EffectSettings& settings) const;
  /// Returns the motion as the forces of a part take it.
  Motion seen_by(std::size_t part, const Point& at, Motion motion) const;
  void add_part_force(const Point& at, std::size_t part, const Motion& motion, Eigen::VectorXd& force) const;
  void link_elasticities();
  void check_laws() const;
  void settle_terms(Part& part) const;
  void find_reacting_regions();
  Eigen::Vector3d spring_reaction(const Reaction& reaction, const Point::Part& own, const Motion& motion) const;
  /// Sums the parts' stiffness at rest, each times its share: all of it, or without what does not relax.
  SparseMatrix sum_stiffness(const Eigen::VectorXd& theta, bool all, const std::function<double(const Part&)>& share) const;

  ModelSettings settings_;
  std::shared_ptr<const Body> body_;
  Eigen::VectorXd rest_;
  ParameterSpace parameters_;
  Eigen::VectorXd prior_theta_;
  Loads loads_;
  Sensors sensors_;
  std::vector<Part> parts_;
  std::vector<Reaction> reactions_;
  std::vector<int> constraint_count_;  ///< number of `fixed` effects that hold each node
  std::vector<char> fixed_;
  bool finite_law_ = false;  ///< the elasticity has a law of finite strain
  bool nonlinear_ = false;
  mutable VectorPool scratch_;  ///< for forces of finite strain that have a share below 1
};

}  // namespace tissue_stiffness
