#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "forward/model.hpp"
#include "forward/output_rows.hpp"

namespace tissue_stiffness {

/// One free run of the model at fixed parameters, from rest at its start. Runs of one ForwardModel share only constant
/// data, so that sigma points advance in parallel.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  /// Integrates up to `time` [s]. Earlier times have no effect. Throws NumericalError when the step diverges however small
  /// it is. The trajectory is then unusable.
  virtual void advance(double time) = 0;
  virtual double time() const = 0;
  /// Returns the nodal displacement, 3n [m].
  virtual Eigen::VectorXd displacement() const = 0;
  /// Returns what sensors depend on: the nodal displacement, and after it each reaction to a prescribed motion (see
  /// Model::output_size).
  virtual Eigen::VectorXd output() const { return displacement(); }
  /// Returns the nodal velocity, 3n [m/s].
  virtual Eigen::VectorXd velocity() const = 0;
};

/// Several free runs, one for each set of parameters.
class Trajectories {
 public:
  virtual ~Trajectories() = default;
  virtual std::size_t size() const = 0;
  /// Advances each run to its own time [s]; they share what they can. Throws as Trajectory::advance, for the first run that
  /// diverges.
  virtual void advance(const std::vector<double>& times) = 0;
  /// Returns the output of each run in a column.
  virtual void outputs(Eigen::MatrixXd& out) const = 0;
  /// Returns their weighted sum at every node, even if the output is restricted, 3n [m].
  virtual void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const = 0;
};

/// Computes sum = sum_i weights[i] displacement(i).
template <typename Displacement>
void add_weighted(const Eigen::VectorXd& weights, const Displacement& displacement, Eigen::Ref<Eigen::VectorXd> sum) {
  sum = weights[0] * displacement(std::size_t{0});
  for (Eigen::Index i = 1; i < weights.size(); ++i) sum += weights[i] * displacement(static_cast<std::size_t>(i));
}

/// Free runs that share no computation.
class SeparateTrajectories : public Trajectories {
 public:
  explicit SeparateTrajectories(std::vector<std::unique_ptr<Trajectory>> runs) : runs_(std::move(runs)) {}
  std::size_t size() const override { return runs_.size(); }
  void advance(const std::vector<double>& times) override;
  void outputs(Eigen::MatrixXd& out) const override;
  void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const override;
  Trajectory& operator[](std::size_t i) { return *runs_[i]; }

 protected:
  std::vector<std::unique_ptr<Trajectory>> runs_;
};

/// Initial state of a free run.
struct RunStart {
  double time = 0.0;                              ///< [s]
  std::shared_ptr<const Trajectory> motion = {};  ///< motion at this time, of the same model; null: at rest, undeformed
};

/// Eq. 1 of Yang & Lin (2016): it maps parameters to a trajectory.
class ForwardModel {
 public:
  virtual ~ForwardModel() = default;
  /// Starts a run at `start` [s], undeformed, at rest or at the initial velocity.
  virtual std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const = 0;
  /// Starts one run for each theta.
  virtual std::unique_ptr<Trajectories> start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const;
  /// Continues another run's motion with other parameters. Displacement, velocity and history stay, and the force changes
  /// abruptly. Throws std::logic_error for an approximate model, whose runs are never resumed.
  virtual std::unique_ptr<Trajectory> resume(const Eigen::VectorXd& theta, const Trajectory& from) const;
  virtual std::unique_ptr<Trajectories> resume_all(const std::vector<Eigen::VectorXd>& thetas,
                                                   const Trajectory& from) const;
  /// Starts from rest or continues a motion, depending on `from`.
  std::unique_ptr<Trajectory> begin(const Eigen::VectorXd& theta, const RunStart& from) const;
  std::unique_ptr<Trajectories> begin_all(const std::vector<Eigen::VectorXd>& thetas, const RunStart& from) const;
  /// Calls `show` at each of `times` [s], ascending, with the index of the time and the run's output.
  using Show = std::function<void(std::size_t, const Eigen::Ref<const Eigen::VectorXd>&)>;
  virtual void advance_through(Trajectory& run, const std::vector<double>& times, const Show& show) const;
  /// Runs started from now on need to give the motion of these nodes only. Cheaper models may leave the others at rest.
  virtual void restrict_output_to(const OutputNodes&) {}
  /// Returns a description in one line.
  virtual std::string description() const = 0;

 protected:
  using Runs = std::vector<std::unique_ptr<Trajectory>>;
  Runs start_each(const std::vector<Eigen::VectorXd>& thetas, double start) const;
  Runs resume_each(const std::vector<Eigen::VectorXd>& thetas, const Trajectory& from) const;
};

struct BasisOptions;
/// Makes a reduced model for a linear model, and a full one otherwise.
std::unique_ptr<ForwardModel> make_forward_model(const Model& model);
/// `relative`: a model of the same body. If both are reduced, identical work is reused.
std::unique_ptr<ForwardModel> make_forward_model(const Model& model, const BasisOptions& options,
                                                 const ForwardModel* relative = nullptr);

}  // namespace tissue_stiffness
