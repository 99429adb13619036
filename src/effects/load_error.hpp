#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/settings/value.hpp"

namespace tissue_stiffness {

/// Errors of a load's sensor, or of a measured motion [m], each as a standard deviation. A negative `bias`, `noise` or
/// `hysteresis` is a share of the largest load in the recording: -0.1 is 10 % of it.
struct LoadTolerance {
  double gain = 0.1;              ///< relative error of the scale [-]
  double bias = -0.1;             ///< constant offset of each component [N or Pa]
  double noise = -0.02;           ///< slow noise of each component [N or Pa]
  double correlation_time = 0.5;  ///< of this noise [s]
  double delay = 0.01;            ///< delay of the load's stamp [s]
  double hysteresis = -0.03;      ///< error of each component along the sign of its rate of change [N or Pa]
  double direction = 0.05;        ///< rotation of the sensor about each axis [rad]; a pressure has none
  bool smooth = false;            ///< the noise has a velocity, as that of a motion does
  /// These are the same errors of a torque, where it acts. A negative one is a share of the largest torque [N m].
  double torque_bias = 0.0, torque_noise = 0.0, torque_hysteresis = 0.0;

  /// Returns whether the load is taken as exact.
  bool exact() const;
};

/// Returns the keys of a load from which its tolerance is read, and the values they take. `unit`: N or Pa.
std::vector<std::pair<std::string, std::string>> load_error_keys(const std::string& unit, bool has_direction);
/// Returns those of a torque.
std::vector<std::pair<std::string, std::string>> torque_error_keys();
/// Reads the tolerance from a load's entry. An estimated `scale` replaces the gain. Throws InputError for a value that is
/// not >= 0.
LoadTolerance read_load_tolerance(const Value& arguments, bool has_direction, bool has_torque);

/// These do the same for the motion that a region follows: errors of its displacement.
std::vector<std::pair<std::string, std::string>> motion_error_keys();
LoadTolerance read_motion_tolerance(const Value& arguments);

/// Linear model of a load's error: measured(t) = true(t) + B(t) eta with eta ~ N(0, I). The columns of B are the measured
/// load (gain), unit loads (bias), the load's rate (delay), the sign of its rate (hysteresis), and its rotation about each
/// axis (direction). Force and torque share gain, delay and direction, because they are of one sensor. Further columns are
/// hat functions, whose covariance at their knots is that of a stationary process (noise): exp(-|t| / T), Ornstein &
/// Uhlenbeck, or for a smooth one (1 + r) exp(-r), r = sqrt(3) |t| / T (Matern 1960).
class LoadErrorBasis {
 public:
  using Load = std::function<Eigen::VectorXd(double)>;  ///< components at a time [s]

  LoadErrorBasis() = default;
  /// `measured`: 1 (pressure), 3 (force) or 6 (force and torque) components; `begin`, `end`: time span of the recording
  /// [s].
  LoadErrorBasis(const LoadTolerance& tolerance, const Load& measured, int components, double begin, double end);

  int size() const { return size_; }
  int components() const { return components_; }
  /// Returns B(t), components x size [N or Pa, and N m].
  Eigen::MatrixXd value(const Load& measured, double time) const;

  enum class Error { gain, bias, delay, hysteresis, direction, noise };
  /// Columns of one kind of error.
  struct Group {
    Error error;
    std::string name;  ///< "gain", "bias", ...; "torque bias" of the torque alone
    int first, count;
    double std;        ///< 1 sigma of one component [unit]
    std::string unit;  ///< "-", "s", "rad", "N m"; empty: that of the load
    int row, rows;     ///< the components that it moves
  };
  const std::vector<Group>& groups() const { return groups_; }

 private:
  /// Components that have one unit: the force, or the torque.
  struct Part {
    int row, rows;
    std::string prefix, unit;
    double bias, noise, hysteresis;  ///< 1 sigma
  };
  void measure(const Load& measured, double end, Part& part);
  void add(Error error, const Part& part, int count, double std, const std::string& unit);
  void place_knots(double end);
  Eigen::RowVectorXd hats(double time) const;

  LoadTolerance tolerance_;
  int components_ = 0, size_ = 0;
  double begin_ = 0.0, spacing_ = 1.0;
  Eigen::VectorXd rates_;  ///< rms of each component's rate over those of its unit
  Eigen::MatrixXd knots_;  ///< square root of the noise's covariance at the knots
  std::vector<Group> groups_;
};

}  // namespace tissue_stiffness
