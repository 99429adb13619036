#pragma once

#include <Eigen/Core>
#include <functional>

#include "filter/noise.hpp"
#include "filter/sigma_points.hpp"

namespace tissue_stiffness {

/// A process model as a filter uses it. It maps sigma points, one in each column, to outputs, one in each column.
using SigmaModel = std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>;

/// Result of an update with a measurement.
struct FilterUpdate {
  Eigen::VectorXd innovation;        ///< y - predicted mean; NaN in unused rows
  Eigen::VectorXd innovation_sigma;  ///< its standard deviation, with prediction and noise; NaN in unused rows
  double nis = 0.0;                  ///< innovation^T P_d^-1 innovation over the rows used
  int dof = 0;                       ///< number of rows used
  double log_likelihood = 0.0;       ///< of the measurement, given all earlier ones
};

/// Unscented filter that carries S with P = S S^T (van der Merwe, Wan 2001) and never forms P. In exact arithmetic it is
/// the paper's filter (Yang, Lin 2016, eq. 9-23). Eq. 23 as printed subtracts, so round-off makes its covariance indefinite
/// when a measurement leaves almost nothing of the prior. Here all factors come from QR of sums of squares (see
/// UnscentedMoments). So P is positive semi-definite by construction, whatever the centre weight. The cost is O(m L^2) for
/// m independent measurements. A step is `filter.update(y, g(filter.sigma_points()), noise)`.
class UnscentedFilter {
 public:
  /// Starts with eq. 9, 10. Throws std::invalid_argument for sizes that do not fit, NumericalError for an indefinite
  /// covariance. A semi-definite one is allowed.
  UnscentedFilter(Eigen::VectorXd mean, const Eigen::MatrixXd& covariance, const UnscentedTuning& tuning = {});
  UnscentedFilter(Eigen::VectorXd mean, const Eigen::MatrixXd& covariance, SigmaSet set);

  const Eigen::VectorXd& mean() const { return mean_; }
  const Eigen::MatrixXd& square_root() const { return square_root_; }  ///< lower triangular, diagonal >= 0
  Eigen::MatrixXd covariance() const { return square_root_ * square_root_.transpose(); }
  /// Returns the points of eq. 13, 14: L x (2L + 1).
  Eigen::MatrixXd sigma_points() const;

  /// Applies x <- f(x) + N(0, B B^T) with the process noise's square root B (L x any number). When an output is not finite,
  /// throws NumericalError and changes nothing.
  void predict(const SigmaModel& process, const Eigen::MatrixXd& noise_square_root);

  /// Applies eq. 18-23 to the outputs of eq. 17, one column for each sigma point. Rows with a NaN in the measurement or in
  /// any output, or with infinite noise, are left out. Without a usable row nothing changes. Throws NumericalError when a
  /// sigma point has no finite output.
  FilterUpdate update(const Eigen::VectorXd& measurement, const Eigen::MatrixXd& outputs, const Noise& noise);

 private:
  Eigen::VectorXd mean_;
  Eigen::MatrixXd square_root_;
  SigmaSet set_;
};

}  // namespace tissue_stiffness
