#pragma once

#include <Eigen/Core>
#include <functional>

#include "tissue_stiffness/filter/noise.hpp"
#include "tissue_stiffness/filter/sigma_points.hpp"

namespace tissue_stiffness {

/// A process model seen by a filter: sigma points in, one a column; outputs out, one a column.
using SigmaModel = std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>;

/// What a measurement said about a filter.
struct FilterUpdate {
  Eigen::VectorXd innovation;        ///< y - predicted mean; NaN in rows that were not used
  Eigen::VectorXd innovation_sigma;  ///< its standard deviation, prediction and noise; NaN in rows that were not used
  double nis = 0.0;                  ///< innovation^T P_d^-1 innovation over the rows used
  int dof = 0;                       ///< rows used
  double log_likelihood = 0.0;       ///< of the measurement given all earlier ones
};

/// The paper's parameter filter (Yang, Lin 2016, eq. 9-23): random-constant parameters, dense covariance. Eq. 23 subtracts,
/// so round-off can make the covariance indefinite when a measurement leaves next to nothing of the prior; update() then
/// throws NumericalError and changes nothing. Cost O(m L^2 + L^3) for m independent rows: the inverse of eq. 21 is taken by
/// Woodbury's identity. A step is `filter.update(y, g(filter.sigma_points()), noise)`.
class UnscentedFilter {
 public:
  /// Eq. 9, 10. Throws std::invalid_argument for sizes that do not fit, NumericalError for an indefinite covariance.
  UnscentedFilter(Eigen::VectorXd mean, Eigen::MatrixXd covariance, const UnscentedTuning& tuning = {});

  const Eigen::VectorXd& mean() const { return mean_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }

  /// Eq. 13, 14: L x (2L + 1).
  Eigen::MatrixXd sigma_points() const;

  /// Eq. 18-23 for the outputs of eq. 17, one column a sigma point. Rows with a NaN in the measurement or in any output, or
  /// with infinite noise, are left out; without a usable row nothing changes. Throws NumericalError when a sigma point has
  /// no finite output.
  FilterUpdate update(const Eigen::VectorXd& measurement, const Eigen::MatrixXd& outputs, const Noise& noise);

 private:
  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
  SigmaSet set_;
};

/// Unscented filter for a general state that carries S with P = S S^T (van der Merwe, Wan 2001) and never forms P. All
/// factors come from QR of sums of squares (see UnscentedMoments), so P is positive semi-definite by construction, whatever
/// the centre weight. Cost O(m L^2) for m independent measurements.
class SquareRootUnscentedFilter {
 public:
  /// Throws std::invalid_argument for sizes that do not fit, NumericalError for an indefinite covariance. A semi-definite
  /// one is fine.
  SquareRootUnscentedFilter(Eigen::VectorXd mean, const Eigen::MatrixXd& covariance, const UnscentedTuning& tuning = {});
  SquareRootUnscentedFilter(Eigen::VectorXd mean, const Eigen::MatrixXd& covariance, SigmaSet set);

  const Eigen::VectorXd& mean() const { return mean_; }
  const Eigen::MatrixXd& square_root() const { return square_root_; }  ///< lower triangular, diagonal >= 0
  Eigen::MatrixXd covariance() const { return square_root_ * square_root_.transpose(); }
  Eigen::MatrixXd sigma_points() const;

  /// x <- f(x) + N(0, B B^T) with the process noise's square root B (L x anything). Throws NumericalError, changing
  /// nothing, when an output is not finite.
  void predict(const SigmaModel& process, const Eigen::MatrixXd& noise_square_root);

  /// As UnscentedFilter::update.
  FilterUpdate update(const Eigen::VectorXd& measurement, const Eigen::MatrixXd& outputs, const Noise& noise);

 private:
  Eigen::VectorXd mean_;
  Eigen::MatrixXd square_root_;
  SigmaSet set_;
};

}  // namespace tissue_stiffness
