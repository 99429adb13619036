#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
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

/// Eq. 1 of Yang & Lin (2016): parameters in, trajectory out.
class ForwardModel {
 public:
  virtual ~ForwardModel() = default;
  /// At rest (or at the initial velocity), undeformed, at `start` [s].
  virtual std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const = 0;
  /// Runs that start from now on need to tell where these nodes are, no others: what is cheaper may leave those at rest.
  virtual void focus(const std::vector<int>&) {}
  /// What it is, in one line.
  virtual std::string description() const = 0;
};

struct BasisOptions;
/// Reduced for a linear model, full otherwise.
std::unique_ptr<ForwardModel> make_forward_model(const Model& model);
std::unique_ptr<ForwardModel> make_forward_model(const Model& model, const BasisOptions& options);

}  // namespace tissue_stiffness
