#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// A normal likelihood of z = [w; eta]: -2 log p(z) = z^T I z - 2 z^T b.
struct LinearFit {
  Eigen::MatrixXd information;  ///< I
  Eigen::VectorXd pull;         ///< b

  void add(const LinearFit& other) {
    information += other.information;
    pull += other.pull;
  }
};

/// Independent normal priors of w and of eta, whose mean is 0.
struct NormalPrior {
  Eigen::VectorXd mean, std;  ///< of w
  Eigen::VectorXd nuisance_std;
};

/// Tells whether a recording asks for the same parameters as others do. Both may have parameters w of their own, w_1 and
/// w_2, while the errors of the rig eta are the same. Let d be the posterior mean of w_1 - w_2, L its covariance, and 2 P
/// the covariance of its prior. Each direction in which L is below a quarter of 2 P counts once:
///   chi2 = sum d_i^2 / (L_i (1 - L_i)),   d_i and L_i in units of the prior.
/// Without a difference a linear model under normal errors gives it the distribution chi^2(dof).
struct Agreement {
  double chi2 = 0.0;
  int dof = 0;  ///< 0: the recordings tell nothing of the same parameter

  /// Returns chi2 as a standard normal number (Wilson & Hilferty 1931); 0 without degrees of freedom.
  double z() const;
  bool passes() const { return z() <= bound; }
  static constexpr double bound = 3.0;  ///< standard deviations
};

Agreement agreement(const LinearFit& one, const LinearFit& others, const NormalPrior& prior);

}  // namespace tissue_stiffness
