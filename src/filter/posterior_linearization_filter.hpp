#pragma once

#include <Eigen/Core>

#include "filter/score_batches.hpp"

namespace tissue_stiffness {

/// Unscented parameter filter in information form, whose sigma points stay where they are anchored.
///
/// The model's free run y_k = h_k(w) from the start of the recording is deterministic in the parameters w. So every sigma
/// point can have its own trajectory as long as it does not move. Each measurement is linearised statistically over the
/// sigma points
///   h_k(w) ~ h_k(a) + H_k (w - a),  H_k from the central differences,
/// and adds H^T R^-1 H to the information. The curvature that the points show is added to the noise. The caller moves the
/// anchor and replays the recording when the estimate leaves the region that the points span, or becomes much sharper than
/// it. This is Gauss-Newton on the exact posterior, with no linearisation left at the end. The covariance is the inverse of
/// a sum of squares and never indefinite. Sources: Yang & Lin 2016, eq. 9-23 (parameter filter); Garcia-Fernandez et al.
/// 2015 (iterated posterior linearisation).
class PosteriorLinearizationFilter {
 public:
  /// Starts from the prior N(mean, covariance) in the filter's coordinates, p and p x p. The anchor is its mean, and the
  /// spread its standard deviations.
  PosteriorLinearizationFilter(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance);

  /// Returns the sigma points, one in each column: the anchor, then anchor + spread_i e_i, then anchor - spread_i e_i. p x
  /// (2p + 1).
  const Eigen::MatrixXd& sigma_points() const { return points_; }
  const Eigen::VectorXd& anchor() const { return anchor_; }
  const Eigen::VectorXd& spread() const { return spread_; }

  /// Moves the sigma points and forgets all measurements. The caller must replay them.
  void move_anchor(const Eigen::VectorXd& anchor, const Eigen::VectorXd& spread);

  struct Innovation {
    double nis = 0.0;   ///< e^T S^-1 e of the innovation before the update
    int dof = 0;        ///< number of rows used
    double cost = 0.0;  ///< weighted sum of (error / sigma)^2 at the anchor
  };
  /// y: m; predictions: m x (2p + 1), one column for each sigma point; variance: m; weight: m, 1 for a good row, towards 0
  /// for an outlier. Rows with a NaN anywhere are left out.
  Innovation update(const Eigen::VectorXd& y, const Eigen::MatrixXd& predictions, const Eigen::VectorXd& variance,
                    const Eigen::VectorXd& weight);

  Eigen::VectorXd mean() const;
  /// Returns the mean with `damping` times the information's diagonal added to the information (Marquardt 1963). The step
  /// is shorter, and more along the directions that the data determine.
  Eigen::VectorXd mean(double damping) const;
  /// Returns the inverse of the information. Both assume a noise variance that is `misfit_scale` times the sensor's.
  Eigen::MatrixXd covariance() const;
  /// Returns the covariance, widened where the errors of successive frames agree more than noise does (score_batches.hpp).
  Eigen::MatrixXd robust_covariance() const;
  /// Returns the mean square of error over sigma at the anchor, at least 1. A model that cannot explain the data must not
  /// be certain of its parameters (the reduced chi-square of Press et al. 2007, sec. 15.1).
  double misfit_scale() const;
  /// Returns the mean square of error over sigma without this bound.
  double mean_square() const { return rows_ > 0 ? data_cost_ / rows_ : 0.0; }
  /// Returns the number of rows of all updates.
  int rows() const { return rows_; }
  /// Returns the cost at the anchor: data cost plus `misfit_scale` times the prior's quadratic form.
  double cost() const { return cost_at(anchor_, data_cost_, rows_); }
  /// Returns the cost at w, where the data of that many rows have the cost `data_cost`.
  double cost_at(const Eigen::VectorXd& w, double data_cost, double rows) const;

  /// Returns the prediction at `w`, interpolated from the sigma points' predictions.
  Eigen::VectorXd predict(const Eigen::MatrixXd& predictions, const Eigen::VectorXd& w) const;
  /// Returns the slopes of the predictions, m x p, as central differences over the spread.
  Eigen::MatrixXd slopes(const Eigen::MatrixXd& predictions) const;

  /// Returns the mean square of the deviation from a straight line through the sigma points, over sigma. It falls with the
  /// fourth power of the spread.
  double nonlinearity() const { return rows_ > 0 ? bend_cost_ / rows_ : 0.0; }

  /// Returns true when the estimate is more than `far` spreads away from the anchor. Also returns true when some spread is
  /// `wide` times its posterior standard deviation and above `floor`.
  bool stale(double far, double wide, const Eigen::VectorXd& floor) const;

 private:
  Eigen::MatrixXd total_information() const;

  Eigen::VectorXd prior_mean_;
  Eigen::MatrixXd prior_information_;
  Eigen::VectorXd anchor_, spread_;
  Eigen::MatrixXd points_;
  Eigen::MatrixXd information_;  ///< information of the data
  Eigen::VectorXd gradient_;     ///< sum of H^T R^-1 e at the anchor
  ScoreBatches scores_;
  double data_cost_ = 0.0, bend_cost_ = 0.0;
  int rows_ = 0;
};

}  // namespace tissue_stiffness
