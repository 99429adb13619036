#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

constexpr double kConfusable = 0.9;  ///< cosine between what two effects explain, above which they are indistinguishable

/// A tangent is a missing effect as the residual sees it, with one column for each component of its amplitude.
struct Tangent {
  Eigen::MatrixXd columns;  ///< N x components: d rows / d amplitude, in sigmas per unit
  Eigen::VectorXd prior_std;
};

/// A score is what the residual says of one tangent.
struct Score {
  Eigen::VectorXd amplitude;      ///< least squares, (x^T x)^-1 x^T e
  double log_bayes_factor = 0.0;  ///< for adding it with its prior
  double explained = 0.0;         ///< sum of squares that it takes off the residual [sigma^2]
  double cosine_with(const Score& other) const;
  Eigen::VectorXd direction;  ///< N: what it explains, unit length; zero when nothing is left of it
};

/// The scorer works on the residual e, where each row's error has the `variance` s [sigma^2]. What `nuisance_tangents` (N x
/// p) explains is first projected off residual and tangents alike:
///   log BF = 1/2 b^T (I + G)^-1 b - 1/2 log |I + G|,  G = D x^T x D / s, b = D x^T e / s, D = diag(prior_std)
class Scorer {
 public:
  Scorer(const Eigen::VectorXd& residual, const Eigen::MatrixXd& nuisance_tangents, double variance);

  Score score(const Tangent& tangent) const;

 private:
  Eigen::MatrixXd project(const Eigen::MatrixXd& x) const;

  Eigen::MatrixXd basis_;  ///< orthonormal, spans `nuisance_tangents`
  Eigen::VectorXd residual_;
  double variance_;
};

/// Returns an orthonormal basis of the columns' span.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

/// Returns the log of the mean of exp(values), without overflow.
double log_mean_exp(const std::vector<double>& values);

/// Returns P(chi^2 >= `gain`) with so many degrees of freedom: the p-value of a likelihood ratio of exp(gain / 2) (Wilks
/// 1938).
double likelihood_ratio_p_value(double gain, double parameters);

/// Returns the z of the mean p-value P(Z >= z) of these tests, of which there is at least one. With one test for each value
/// of an unknown nuisance, this is the test by the prior predictive p-value (Box 1980).
double averaged_z(const std::vector<double>& z);

/// Returns the log Bayes factor against a hypothesis whose test lies z standard deviations above its mean, p = P(Z >= z).
/// Under something unknown, p has the density k p^(k - 1), 0 < k < 1, which is larger the smaller p is. Nothing is known of
/// k, so the factor is the mean over k (Vovk & Wang 2021, Ann. Stat. 49(3), section 2):
///   (1 - p + p log p) / (p (log p)^2).
/// Its mean under the hypothesis is 1, as that of a Bayes factor has to be. It is at least 1/2.
double log_bayes_factor_of_test(double z);

/// Returns the log Bayes factor that is believed of a larger model over a smaller one, whose test lies z standard
/// deviations above its mean. It is no more than the `whole` evidence says, and no more than either the test or the `modal`
/// evidence says, that of what the sensors see along the lowest modes. The mesh's error has a known covariance along these
/// modes alone, so whatever else the evidence holds may be that error. `modal` is the least over the sizes of that error:
/// the lower bound of a robust Bayesian analysis (Berger 1994, Test 3).
double believed_gain(double whole, double modal, double z);

}  // namespace tissue_stiffness
