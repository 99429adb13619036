#pragma once

#include <Eigen/Core>
#include <optional>

#include "tissue_stiffness/fem/newmark.hpp"
#include "tissue_stiffness/fem/nodal_rotation.hpp"
#include "tissue_stiffness/forward/forward_model.hpp"

namespace tissue_stiffness {

/// Every node of the mesh, integrated with implicit Newmark or generalised-alpha steps.
class FullModel : public ForwardModel {
 public:
  struct Options {
    double step = 0.0;             ///< [s]; 0: a fraction of the span that advance() is asked for
    int steps_per_frame = 4;       ///< when step is 0
    double spectral_radius = 0.9;  ///< of generalised-alpha at infinite frequency; 1 is Newmark's average acceleration
    double tolerance = 3e-6;       ///< corrections left out over the body's size: the filter lives on differences of runs
  };
  FullModel(const Model& model, const Options& options) : model_(model), options_(options) {}

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  /// Runs that hold the same nodes step side by side around one factor.
  std::unique_ptr<Trajectories> start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const override;
  std::unique_ptr<Trajectory> resume(const Eigen::VectorXd& theta, const Trajectory& from) const override;
  std::unique_ptr<Trajectories> resume_all(const std::vector<Eigen::VectorXd>& thetas,
                                           const Trajectory& from) const override;
  std::string description() const override;

 private:
  bool hold_the_same(const std::vector<Eigen::VectorXd>& thetas) const;

  const Model& model_;
  Options options_;
};

/// Model at one theta as the integrator sees it.
class ModelSystem : public DynamicSystem {
 public:
  ModelSystem(const Model& model, const Eigen::VectorXd& theta);

  const SparseMatrix& mass() const override { return mass_; }
  const SparseMatrix& damping() const override { return damping_; }
  bool damped() const override { return damped_; }
  const std::vector<char>& fixed() const override { return fixed_; }
  const std::vector<Relaxation>& relaxations() const override { return relaxations_; }
  const SparseMatrix& relaxing_stiffness() const override { return reference_; }
  void add_force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v, Eigen::VectorXd& force) const override;
  SparseMatrix stiffness(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const override;
  bool rubs() const override { return rubs_; }
  SparseMatrix friction(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const override;
  /// A diagonal can stand for the mass, and no force changes faster with the velocity than explicit steps follow.
  bool can_leap() const { return leaps_; }
  void find_rotations(const Eigen::VectorXd& u, Eigen::Matrix3Xd& rotations) const override;
  /// Kinetic and stored energy less the work of gravity [J].
  double energy(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;

 private:
  const Model& model_;
  Model::Point point_;
  SparseMatrix mass_, damping_, stiffness_, reference_;
  std::vector<char> fixed_;
  std::vector<Relaxation> relaxations_;
  Eigen::VectorXd gravity_;
  std::optional<NodalRotations> rotations_;  ///< where the whole stiffness turns with the material
  bool damped_ = false, linear_part_ = false, rubs_ = false, leaps_ = true;
};

}  // namespace tissue_stiffness
