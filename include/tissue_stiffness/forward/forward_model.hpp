#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/forward/model.hpp"

namespace tissue_stiffness {

/// One free run of the model at fixed parameters, from rest at its start. Runs of one ForwardModel share only constant
/// data, so sigma points advance in parallel.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  /// Integrates up to `time` [s]; earlier times are left where they are. Throws NumericalError when the step diverges
  /// however small it is cut; the trajectory is then unusable.
  virtual void advance(double time) = 0;
  virtual double time() const = 0;
  /// Nodal displacement, 3n [m].
  virtual Eigen::VectorXd displacement() const = 0;
  /// Nodal velocity, 3n [m/s].
  virtual Eigen::VectorXd velocity() const = 0;
};

/// Free runs side by side, one a set of parameters.
class Trajectories {
 public:
  virtual ~Trajectories() = default;
  virtual std::size_t size() const = 0;
  /// Each to its own time [s]; they share what they can. Throws as Trajectory::advance, for the first that diverges.
  virtual void advance(const std::vector<double>& times) = 0;
  /// Nodal displacements, a column each, 3n x size [m].
  virtual void displacements(Eigen::MatrixXd& out) const = 0;
  /// Their weighted sum at every node, whatever the focus, 3n [m].
  virtual void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const = 0;
};

/// sum = sum_i weights[i] displacement(i).
template <typename Displacement>
void weigh(const Eigen::VectorXd& weights, const Displacement& displacement, Eigen::Ref<Eigen::VectorXd> sum) {
  sum = weights[0] * displacement(std::size_t{0});
  for (Eigen::Index i = 1; i < weights.size(); ++i) sum += weights[i] * displacement(static_cast<std::size_t>(i));
}

/// Free runs that share nothing but the cores.
class SeparateTrajectories : public Trajectories {
 public:
  explicit SeparateTrajectories(std::vector<std::unique_ptr<Trajectory>> runs) : runs_(std::move(runs)) {}
  std::size_t size() const override { return runs_.size(); }
  void advance(const std::vector<double>& times) override;
  void displacements(Eigen::MatrixXd& out) const override;
  void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const override;
  Trajectory& operator[](std::size_t i) { return *runs_[i]; }

 protected:
  std::vector<std::unique_ptr<Trajectory>> runs_;
};

/// Where a free run begins.
struct RunStart {
  double time = 0.0;                              ///< [s]
  std::shared_ptr<const Trajectory> motion = {};  ///< at that time, of the same model; null: at rest, undeformed
};

/// Eq. 1 of Yang & Lin (2016): parameters in, trajectory out.
class ForwardModel {
 public:
  virtual ~ForwardModel() = default;
  /// At rest (or at the initial velocity), undeformed, at `start` [s].
  virtual std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const = 0;
  /// One run for each theta.
  virtual std::unique_ptr<Trajectories> start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const;
  /// Goes on from another run's motion at other parameters: displacement, velocity and history stay, the force jumps.
  /// Throws std::logic_error for a model that only stands in for another one, which nothing resumes.
  virtual std::unique_ptr<Trajectory> resume(const Eigen::VectorXd& theta, const Trajectory& from) const;
  virtual std::unique_ptr<Trajectories> resume_all(const std::vector<Eigen::VectorXd>& thetas,
                                                   const Trajectory& from) const;
  /// From rest or from a motion, as `from` says.
  std::unique_ptr<Trajectory> begin(const Eigen::VectorXd& theta, const RunStart& from) const;
  std::unique_ptr<Trajectories> begin_all(const std::vector<Eigen::VectorXd>& thetas, const RunStart& from) const;
  /// Shows where the nodes are at each of `times` [s], ascending, by the index of the time and their displacement (3n).
  using Show = std::function<void(std::size_t, const Eigen::Ref<const Eigen::VectorXd>&)>;
  virtual void advance_through(Trajectory& run, const std::vector<double>& times, const Show& show) const;
  /// Runs that start from now on need to tell where these nodes are, no others: what is cheaper may leave those at rest.
  virtual void focus(const std::vector<int>&) {}
  /// What it is, in one line.
  virtual std::string description() const = 0;

 protected:
  using Runs = std::vector<std::unique_ptr<Trajectory>>;
  Runs start_each(const std::vector<Eigen::VectorXd>& thetas, double start) const;
  Runs resume_each(const std::vector<Eigen::VectorXd>& thetas, const Trajectory& from) const;
};

struct BasisOptions;
/// Reduced for a linear model, full otherwise.
std::unique_ptr<ForwardModel> make_forward_model(const Model& model);
/// `relative`: a model of the same body, whose work is taken over where both are reduced and it would be the same.
std::unique_ptr<ForwardModel> make_forward_model(const Model& model, const BasisOptions& options,
                                                 const ForwardModel* relative = nullptr);

}  // namespace tissue_stiffness
