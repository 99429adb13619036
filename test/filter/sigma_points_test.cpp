#include "filter/sigma_points.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace tissue_stiffness {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& engine) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(engine); });
}

const std::vector<UnscentedTuning> tunings = {{1.0, 2.0, 0.0}, {0.1, 2.0, 0.0}, {2.0, 2.0, 0.0},
                                              {0.5, 0.0, 1.0}, {1.5, 0.0, 0.0}, {1e-3, 2.0, 3.0}};

TEST(SigmaSet, WeightsAreEquation15) {
  for (const UnscentedTuning& tuning : tunings) {
    for (int l = 1; l <= 6; ++l) {
      const SigmaSet set = SigmaSet::scaled(l, tuning);
      const double alpha2 = tuning.alpha * tuning.alpha, lambda = alpha2 * (l + tuning.kappa) - l;
      ASSERT_EQ(set.unit().cols(), 2 * l + 1);
      const double size = set.mean_weights().cwiseAbs().sum();  // round-off grows with it
      EXPECT_NEAR(set.mean_weights().sum(), 1.0, 1e-14 * size);
      EXPECT_NEAR(set.mean_weights()[0], lambda / (l + lambda), 1e-10 * size);
      EXPECT_NEAR(set.mean_weights()[1], 0.5 / (l + lambda), 1e-10 * size);
      // Eq. 15's centre weight makes this sum 2 - alpha^2 + beta; eq. 16 only holds for the mean's weights.
      EXPECT_NEAR(set.covariance_weights().sum(), 2.0 - alpha2 + tuning.beta, 1e-13 * size);
      EXPECT_NEAR(set.unit()(0, 1), std::sqrt(l + lambda), 1e-10 * std::sqrt(l + lambda));
    }
  }
}

TEST(SigmaSet, PointsHaveTheMeanAndCovarianceTheyWereDrawnFor) {
  std::mt19937 engine(1);
  for (int l = 1; l <= 7; ++l) {
    const Eigen::VectorXd mean = random_matrix(l, 1, engine);
    const Eigen::MatrixXd root = random_matrix(l, l, engine);
    for (const SigmaSet& set : {SigmaSet::scaled(l, {0.7, 2.0, 0.5}), SigmaSet::simplex(l)}) {
      const Eigen::MatrixXd points = set.points(mean, root);
      const Eigen::VectorXd found = points * set.mean_weights();
      const Eigen::MatrixXd deviations = points.colwise() - mean;
      const Eigen::MatrixXd covariance = deviations * set.mean_weights().asDiagonal() * deviations.transpose();
      EXPECT_LT((found - mean).norm(), 1e-13);
      EXPECT_LT((covariance - root * root.transpose()).norm(), 1e-12);
    }
  }
}

/// The sum of squares equals the paper's weighted sums, centre weight negative or not.
TEST(SigmaSet, MomentsEqualEquations18To20) {
  std::mt19937 engine(2);
  for (const UnscentedTuning& tuning : tunings) {
    for (int l = 1; l <= 5; ++l) {
      const SigmaSet set = SigmaSet::scaled(l, tuning);
      const Eigen::MatrixXd outputs = random_matrix(8, 2 * l + 1, engine);
      const Eigen::MatrixXd root = random_matrix(l, l, engine);
      const Eigen::VectorXd mean = outputs * set.mean_weights();
      const Eigen::MatrixXd deviations = outputs.colwise() - mean;
      const Eigen::MatrixXd covariance = deviations * set.covariance_weights().asDiagonal() * deviations.transpose();
      const Eigen::MatrixXd cross = root * set.unit() * set.covariance_weights().asDiagonal() * deviations.transpose();
      const UnscentedMoments moments = set.moments(outputs);
      const double size = covariance.norm();
      EXPECT_LT((moments.mean - mean).norm(), 1e-9 * mean.norm());
      EXPECT_LT((root * moments.linear.transpose() - cross).norm(), 1e-9 * cross.norm());
      const Eigen::MatrixXd squares =
          moments.linear * moments.linear.transpose() + moments.remainder * moments.remainder.transpose();
      EXPECT_LT((squares - covariance).norm(), 1e-9 * size) << "alpha " << tuning.alpha << ", L " << l;
    }
  }
}

/// y = x^T A x for x ~ N(mu, I): mean mu^T A mu + tr A; in one dimension, kappa = 0 and beta = 2 give the variance exactly.
TEST(SigmaSet, QuadraticModel) {
  std::mt19937 engine(3);
  for (const double alpha : {0.1, 1.0, 1.7}) {
    const SigmaSet one = SigmaSet::scaled(1, {alpha, 2.0, 0.0});
    const double mu = 0.7, sigma = 0.4;
    const Eigen::MatrixXd x = one.points(Eigen::VectorXd::Constant(1, mu), Eigen::MatrixXd::Constant(1, 1, sigma));
    const UnscentedMoments moments = one.moments(x.cwiseAbs2());
    EXPECT_NEAR(moments.mean[0], mu * mu + sigma * sigma, 1e-12);
    const double variance = moments.linear.squaredNorm() + moments.remainder.squaredNorm();
    EXPECT_NEAR(variance, 4 * mu * mu * sigma * sigma + 2 * std::pow(sigma, 4), 1e-12);

    const int l = 4;
    const Eigen::MatrixXd half = random_matrix(l, l, engine), a = half + half.transpose();
    const Eigen::VectorXd centre = random_matrix(l, 1, engine);
    for (const SigmaSet& set : {SigmaSet::scaled(l, {alpha, 2.0, 0.0}), SigmaSet::simplex(l)}) {
      const Eigen::MatrixXd points = set.points(centre, Eigen::MatrixXd::Identity(l, l));
      Eigen::MatrixXd values(1, points.cols());
      for (Eigen::Index i = 0; i < points.cols(); ++i) values(0, i) = points.col(i).dot(a * points.col(i));
      EXPECT_NEAR(set.moments(values).mean[0], centre.dot(a * centre) + a.trace(), 1e-11);
    }
  }
}

TEST(SigmaSet, RefusesWhatHasNoMeaning) {
  EXPECT_THROW(SigmaSet::scaled(0, {}), std::invalid_argument);
  EXPECT_THROW(SigmaSet::simplex(0), std::invalid_argument);
  EXPECT_THROW(SigmaSet::scaled(2, {0.0, 2.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(SigmaSet::scaled(2, {1.0, -1.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(SigmaSet::scaled(2, {1.0, 2.0, -1.0}), std::invalid_argument);
  EXPECT_THROW(SigmaSet::simplex(2).moments(Eigen::MatrixXd::Zero(3, 5)), std::invalid_argument);
}

TEST(LowerSquareRoot, IsLowerTriangularAndKeepsTheProduct) {
  std::mt19937 engine(4);
  for (const auto& [rows, columns] : {std::pair<int, int>{4, 4}, {3, 9}, {5, 2}, {1, 1}}) {
    const Eigen::MatrixXd a = random_matrix(rows, columns, engine);
    const Eigen::MatrixXd lower = lower_square_root(a);
    EXPECT_LT((lower * lower.transpose() - a * a.transpose()).norm(), 1e-13 * a.squaredNorm());
    EXPECT_EQ(Eigen::MatrixXd(lower.triangularView<Eigen::StrictlyUpper>()).norm(), 0.0);
    EXPECT_GE(lower.diagonal().minCoeff(), 0.0);
  }
}

}  // namespace
}  // namespace tissue_stiffness
