#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/filter/score_batches.hpp"

namespace tissue_stiffness {

/// Unscented parameter filter in information form, with sigma points that stay where they are anchored.
///
/// The model's free run y_k = h_k(w) from the start of the recording is deterministic in the parameters w, so every sigma
/// point can carry its own trajectory as long as it does not move. Each measurement is linearised statistically over the
/// sigma points
///   h_k(w) ~ h_k(a) + H_k (w - a),  H_k from the central differences,
/// with the curvature that the points show added to the noise, and adds H^T R^-1 H to the information. When the estimate
/// leaves the region that the points span, or becomes much sharper than it, the caller moves the anchor there and replays
/// the recording: Gauss-Newton on the exact posterior, with no linearisation left at the end. Covariance is the inverse of
/// a sum of squares: never indefinite. Sources: Yang & Lin 2016, eq. 9-23 (parameter filter); Garcia-Fernandez et al. 2015
/// (iterated posterior linearisation).
class AnchoredFilter {
 public:
  /// Prior N(mean, covariance) in the filter's coordinates, p and p x p; anchored at its mean, with its standard deviations
  /// for a spread.
  AnchoredFilter(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance);

  /// Sigma points, one a column: the anchor, then anchor + spread_i e_i, then anchor - spread_i e_i. p x (2p + 1).
  const Eigen::MatrixXd& sigma_points() const { return points_; }
  const Eigen::VectorXd& anchor() const { return anchor_; }
  const Eigen::VectorXd& spread() const { return spread_; }

  /// Moves the sigma points and forgets all measurements: the caller replays them.
  void move_anchor(const Eigen::VectorXd& anchor, const Eigen::VectorXd& spread);

  struct Innovation {
    double nis = 0.0;   ///< e^T S^-1 e of the innovation before the update
    int dof = 0;        ///< rows used
    double cost = 0.0;  ///< weighted sum of (error / sigma)^2 at the anchor
  };
  /// y: m; predictions: m x (2p + 1), one column a sigma point; variance: m; weight: m, 1 for a sound row, towards 0 for an
  /// outlier. Rows with a NaN anywhere are left out.
  Innovation update(const Eigen::VectorXd& y, const Eigen::MatrixXd& predictions, const Eigen::VectorXd& variance,
                    const Eigen::VectorXd& weight);

  Eigen::VectorXd mean() const;
  /// The same with `damping` times the information's diagonal added to it (Marquardt 1963): shorter, and more along what
  /// the data tell.
  Eigen::VectorXd mean(double damping) const;
  /// Inverse of the information; both count the noise as `misfit_scale` times larger in variance than the sensor's.
  Eigen::MatrixXd covariance() const;
  /// The same, wider where the errors of successive frames agree more than noise does (score_batches.hpp).
  Eigen::MatrixXd robust_covariance() const;
  /// Mean square of error over sigma at the anchor, at least 1: a model that cannot explain the data must not be sure of
  /// its parameters (the reduced chi-square of Press et al. 2007, sec. 15.1).
  double misfit_scale() const;
  /// The same without the bound.
  double mean_square() const { return rows_ > 0 ? data_cost_ / rows_ : 0.0; }
  /// Log-posterior's quadratic part at the anchor so far: data cost plus the prior's.
  double cost() const { return cost_at(anchor_, data_cost_, rows_); }
  /// The same at w, where the data of so many rows cost so much.
  double cost_at(const Eigen::VectorXd& w, double data_cost, double rows) const;

  /// Prediction at `w` from the sigma points' predictions.
  Eigen::VectorXd predict(const Eigen::MatrixXd& predictions, const Eigen::VectorXd& w) const;
  /// Same by slopes alone: m x p, central differences over the spread.
  Eigen::MatrixXd slopes(const Eigen::MatrixXd& predictions) const;

  /// Mean square of what a straight line through the sigma points misses, over sigma; falls with the fourth power of the
  /// spread.
  double nonlinearity() const { return rows_ > 0 ? bend_cost_ / rows_ : 0.0; }

  /// True when the estimate is more than `far` spreads away from the anchor, or some spread is `wide` times its posterior
  /// standard deviation and above `floor`.
  bool stale(double far, double wide, const Eigen::VectorXd& floor) const;

 private:
  Eigen::MatrixXd total_information() const;

  Eigen::VectorXd prior_mean_;
  Eigen::MatrixXd prior_information_;
  Eigen::VectorXd anchor_, spread_;
  Eigen::MatrixXd points_;
  Eigen::MatrixXd information_;  ///< of the data
  Eigen::VectorXd gradient_;     ///< H^T R^-1 e summed, at the anchor
  ScoreBatches scores_;
  double data_cost_ = 0.0, bend_cost_ = 0.0;
  int rows_ = 0;
};

}  // namespace tissue_stiffness
