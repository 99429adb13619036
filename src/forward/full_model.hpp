#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "fem/generalized_alpha.hpp"
#include "fem/nodal_deformation.hpp"
#include "forward/forward_model.hpp"

namespace tissue_stiffness {

class ReducedModel;

/// All degrees of freedom of the mesh, integrated with implicit Newmark or generalised-alpha steps.
class FullModel : public ForwardModel {
 public:
  struct Options {
    double step = 0.0;             ///< [s]; 0: a fraction of the time span of advance()
    int steps_per_frame = 4;       ///< used when step is 0
    double spectral_radius = 0.9;  ///< of generalised-alpha at infinite frequency; 1 is Newmark's average acceleration
    /// Neglected corrections over the body's size: small, as the filter uses differences of runs. Under finite strain they
    /// are smaller by the ratio of the moduli lambda and mu over 9, where that is above 1.
    double tolerance = 3e-6;
    /// Called after every step with the states of all runs that are stepped together; null: not.
    std::function<void(const std::vector<DynamicState>&)> after_step = nullptr;
  };
  FullModel(const Model& model, const Options& options);
  ~FullModel() override;

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  /// Runs that hold the same nodes are stepped together with one factor.
  std::unique_ptr<Trajectories> start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const override;
  std::unique_ptr<Trajectory> resume(const Eigen::VectorXd& theta, const Trajectory& from) const override;
  std::unique_ptr<Trajectories> resume_all(const std::vector<Eigen::VectorXd>& thetas,
                                           const Trajectory& from) const override;
  /// Returns the states of a run at its start and at later `times` [s], ascending. `checkpoint` is called before each time.
  std::vector<DynamicState> states(const Eigen::VectorXd& theta, double start, const std::vector<double>& times,
                                   const std::function<void()>& checkpoint) const;
  std::string description() const override;
  const Options& options() const { return options_; }

 private:
  bool hold_the_same(const std::vector<Eigen::VectorXd>& thetas) const;

  const Model& model_;
  Options options_;
  std::unique_ptr<ReducedModel> linear_form_;  ///< for a start in motion; null: from rest
};

/// The model at one theta, in the form that the integrator needs.
class ModelSystem : public DynamicSystem {
 public:
  ModelSystem(const Model& model, const Eigen::VectorXd& theta);

  const SparseMatrix& mass() const override { return mass_; }
  const SparseMatrix& damping() const override { return damping_; }
  bool damped() const override { return damped_; }
  const Eigen::VectorXd& gravity() const { return gravity_; }  ///< [N]
  const std::vector<char>& fixed() const override { return fixed_; }
  const std::vector<Relaxation>& relaxations() const override { return relaxations_; }
  const SparseMatrix& relaxing_stiffness() const override { return reference_; }
  /// Where a law may have its stress in finite strain, the displacement is followed by Green's strain.
  void find_relaxing_strain(const Eigen::VectorXd& u, Eigen::VectorXd& strain) const override;
  void subtract_relaxing_force(const Eigen::VectorXd& u, const Eigen::VectorXd& stretch,
                               Eigen::VectorXd& force) const override;
  void add_force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v, Eigen::VectorXd& force) const override;
  SparseMatrix stiffness(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const override;
  bool has_velocity_tangent() const override { return velocity_tangent_; }
  SparseMatrix friction(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const override;
  /// Returns whether the mass can be lumped, and no force changes faster with the velocity than explicit steps can follow.
  bool supports_explicit_steps() const { return explicit_steps_; }
  /// Returns the largest ratio of the moduli lambda and mu of a law of finite strain in the body.
  double largest_lame_ratio() const;
  void find_deformation(const Eigen::VectorXd& u, Eigen::Matrix3Xd& gradients) const override;
  /// Returns the forces of the springs that impose motions, and of tools [N], see Model::find_reactions.
  Eigen::VectorXd reactions(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;
  /// Returns kinetic and stored energy less the work of gravity [J].
  double energy(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;

 private:
  const Model& model_;
  Model::Point point_;
  SparseMatrix mass_, damping_, stiffness_, reference_, linear_reference_;
  std::vector<char> fixed_;
  std::vector<Relaxation> relaxations_;
  Eigen::VectorXd gravity_;
  std::optional<NodalDeformation> deformation_;  ///< if the whole stiffness moves with the material
  bool damped_ = false, linear_part_ = false, velocity_tangent_ = false, explicit_steps_ = true, strains_relax_ = false;
};

}  // namespace tissue_stiffness
