#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// A missing effect as the residual sees it: one column a component of its amplitude.
struct Tangent {
  Eigen::MatrixXd columns;  ///< N x components: d rows / d amplitude, in sigmas per unit
  Eigen::VectorXd prior_std;
};

/// What the residual says of one tangent.
struct Score {
  Eigen::VectorXd amplitude;      ///< least squares, (x^T x)^-1 x^T e
  double log_bayes_factor = 0.0;  ///< of adding it with its prior, for independent noise of one sigma
  double p_value = 1.0;           ///< of its amplitude being zero, errors correlated in time (HAC)
  double size = 0.0;              ///< rms over rows of what it explains [sigma]
  double explained = 0.0;         ///< share of the residual's sum of squares
  double cosine_with(const Score& other) const;
  Eigen::VectorXd direction;  ///< N: what it explains, unit length; zero when nothing is left of it
};

/// Scores on the residual e, after what `known` (N x p) explains is projected off residual and tangents alike.
///   log BF = 1/2 b^T (I + G)^-1 b - 1/2 log |I + G|,  G = D x^T x D, b = D x^T e, D = diag(prior_std)
/// with the squared sigma taken as max(1, `variance`). The p-value is Wald's. What an error e - x theta remembers of the
/// last frame's is taken off it (prewhitening, Andrews & Monahan 1992, with one autocorrelation for all rows), the rest has
/// a Newey-West covariance, against the F distribution that goes with the bandwidth (Sun 2014). `doubt` (N, or nothing): an
/// error of unknown sign that may be in e, 1 sigma; it widens the covariance by (x^T doubt)^2.
/// `offsets`: first row of each frame, N at the end.
class Scorer {
 public:
  Scorer(const Eigen::VectorXd& residual, const Eigen::MatrixXd& known, std::vector<Eigen::Index> offsets, double variance,
         const Eigen::VectorXd& doubt = {});

  Score score(const Tangent& tangent) const;
  /// Two effects at once, for pairs that only explain the residual together. Their evidence decides: no p-value.
  Score score(const Tangent& a, const Tangent& b) const;
  /// rms over rows of what is left of a column after the projection [its unit].
  double remaining(const Eigen::VectorXd& column) const;
  const Eigen::VectorXd& residual() const { return residual_; }

 private:
  Score score(const Tangent& tangent, bool with_p_value) const;
  Eigen::MatrixXd project(const Eigen::MatrixXd& x) const;
  struct Terms {
    Eigen::MatrixXd unit;   ///< frames x columns: uncorrelated terms of x^T e, each of unit variance
    double variance = 0.0;  ///< of their sum
  };
  Terms terms(const Eigen::MatrixXd& x, const Eigen::VectorXd& left) const;
  double p_value(const Eigen::MatrixXd& x, const Eigen::VectorXd& left) const;
  double memory_of(const Eigen::VectorXd& left) const;
  Eigen::Index frames() const { return static_cast<Eigen::Index>(offsets_.size()) - 1; }
  Eigen::Index offset(Eigen::Index frame) const { return offsets_[static_cast<std::size_t>(frame)]; }
  Eigen::Index count(Eigen::Index frame) const { return offset(frame + 1) - offset(frame); }

  Eigen::MatrixXd basis_;  ///< orthonormal, of `known`
  Eigen::VectorXd residual_, doubt_;
  std::vector<Eigen::Index> offsets_;
  double variance_;
};

/// One p-value of several ways in which the same effect may be missing: Sidak's for the best of them, with the number of
/// tests that so many directions amount to, (sum sqrt(l))^2 / sum l of the eigenvalues l of their cosines (Galwey 2009).
/// Ways that say nothing do not count. 1 without any.
double combined_p_value(const std::vector<const Score*>& ways);

/// One-sided p-value of a model not predicting better than another: `gains` are the other's squared errors less its own,
/// one a frame, correlated in time (Diebold & Mariano 1995, with the distribution that goes with the bandwidth). 1 without
/// frames.
double prediction_p_value(const Eigen::VectorXd& gains);

/// log of the mean of exp(values), without overflow.
double log_mean_exp(const std::vector<double>& values);

}  // namespace tissue_stiffness
