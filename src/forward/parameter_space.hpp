#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"

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
  int index = 0;     ///< in theta, or `surface`
  double value = 0.0;
  double std = 0.0;  ///< tolerance, 1 sigma [the parameter's unit]
  static constexpr int surface = -1;  ///< how far out the surface lies [m], which is no parameter
};

/// All numbers of a model. The vector theta holds the values of every parameter of every effect in order, and then the
/// initial velocity [m/s]. The filter's coordinates w hold those that are estimated.
class ParameterSpace {
 public:
  /// Appends an effect's parameters as the model file gives them. Returns their indices in theta.
  std::vector<int> add(const EffectSettings& effect, bool exact_inputs);
  /// Appends the initial velocity, the last three of theta.
  void add_initial_velocity(const InitialSettings& initial);

  const std::vector<FreeParameter>& free() const { return free_; }
  /// Returns the declared numbers that have a tolerance.
  const std::vector<UncertainConstant>& uncertain_constants() const { return constants_; }
  /// Returns theta with the free parameters at their prior.
  const Eigen::VectorXd& known() const { return known_; }
  /// Returns whether the parameter at this index of theta is free.
  bool is_free(int index) const;

  /// Returns theta for the filter's coordinates w. Values are clamped to the parameters' bounds.
  Eigen::VectorXd theta(const Eigen::VectorXd& w) const;
  /// These describe the prior in the filter's coordinates.
  Eigen::VectorXd prior_mean() const;
  Eigen::VectorXd prior_std() const;
  /// Returns the change of each coordinate after one second, 1 sigma; 0 if it is constant.
  Eigen::VectorXd drift() const;
  /// Returns the free parameters in their own units, by name; w: filter coordinates.
  std::map<std::string, double> values(const Eigen::VectorXd& w) const;
  /// Returns `w` with the free parameters that are named in `values` set to their values there.
  Eigen::VectorXd coordinates(const std::map<std::string, double>& values, Eigen::VectorXd w) const;

  /// Replaces the prior of a free initial velocity, mean and std [m/s].
  void set_velocity_prior(const Eigen::Vector3d& mean, double std);
  /// Restores the prior of a free initial velocity before any frame.
  void forget_velocity_prior();
  /// Fixes all parameters at theta; from now on none is free.
  void know(const Eigen::VectorXd& theta);

 private:
  bool velocity_is_free_ = false;
  std::vector<FreeParameter> free_;
  std::vector<UncertainConstant> constants_;
  std::vector<int> free_index_;  ///< index of each free parameter in theta
  Eigen::VectorXd known_;
};

}  // namespace tissue_stiffness
