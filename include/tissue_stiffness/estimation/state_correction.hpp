#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/forward/reduced_trajectory.hpp"

namespace tissue_stiffness {

/// Kalman filter on the lowest modes of a linear model that misses some physics: what it misses acts as a white modal
/// force. A run is corrected towards each frame; the next frame's error, whitened by its covariance S = H P H^T + R, then
/// speaks of the parameters alone (prediction-error method: Ljung 1999, sec. 7.4; Astrom 1980). Without force it is the
/// free run. The runs of all sigma points share the gain of the anchor's.
class StateCorrection {
 public:
  /// force: root mean square of the missing modal force [N/sqrt(kg)], over the interval between two frames.
  explicit StateCorrection(double force) : force_(force) {}

  static constexpr int most_modes = 12;

  void restart() { root_.resize(0, 0); }
  /// Carries the covariance over `span` [s] along `run`, the anchor's.
  void advance(const ReducedTrajectory& run, double span);

  struct Whitened {
    Eigen::VectorXd measured;  ///< m, unit variance; NaN where a row says nothing
    Eigen::MatrixXd rows;      ///< m x points
    Eigen::MatrixXd step;      ///< 2 modes x points: what to add to each run's modal displacement and velocity
    double log_determinant = 0.0;
  };
  /// measured: m; rows: m x points, predictions of each run; precision: m, weight over variance, 0 for an unusable row;
  /// sensitivity: m x modes, d prediction / d modal displacement.
  Whitened update(const Eigen::VectorXd& measured, const Eigen::MatrixXd& rows, const Eigen::VectorXd& precision,
                  const Eigen::MatrixXd& sensitivity);

 private:
  double force_;
  Eigen::MatrixXd root_;  ///< P = root root^T of [displacement; velocity] of the modes
};

}  // namespace tissue_stiffness
