#include "diagnosis/scores.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "filter/consistency.hpp"

namespace tissue_stiffness {
namespace {

constexpr Eigen::Index kFrames = 80, kRowsEach = 30, kRows = kFrames * kRowsEach;

Eigen::VectorXd noise(std::mt19937& engine) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(kRows, [&](auto) { return normal(engine); });
}

// Returns a motion of the whole body that rings at `frequency` and dies over `life` frames.
Eigen::MatrixXd ringing(double frequency, double life, unsigned seed = 1) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const Eigen::VectorXd shape = Eigen::VectorXd::NullaryExpr(kRowsEach, [&](auto) { return normal(engine); });
  Eigen::MatrixXd x(kRows, 1);
  for (Eigen::Index t = 0; t < kFrames; ++t) {
    const double course = std::exp(-static_cast<double>(t) / life) * std::sin(frequency * static_cast<double>(t));
    x.block(t * kRowsEach, 0, kRowsEach, 1) = course * shape;
  }
  return x;
}

Tangent tangent(const Eigen::MatrixXd& columns, double prior = 1.0) {
  return {columns, Eigen::VectorXd::Constant(columns.cols(), prior)};
}

TEST(Scores, RecoverTheAmplitudeAndTheShareExplained) {
  std::mt19937 engine(2);
  const Eigen::MatrixXd x = ringing(0.3, 30.0);
  const Eigen::VectorXd e = 2.5 * x.col(0) + noise(engine);
  const Score score = Scorer(e, Eigen::MatrixXd(kRows, 0), 1.0).score(tangent(x));
  const double std = 1.0 / x.norm();
  EXPECT_NEAR(score.amplitude[0], 2.5, 4.0 * std);
  EXPECT_NEAR(score.explained / (6.25 * x.squaredNorm()), 1.0, 0.05);
  EXPECT_GT(score.log_bayes_factor, 100.0);
}

TEST(Scores, LogBayesFactorIsTheClosedFormOfOneColumn) {
  std::mt19937 engine(3);
  const Eigen::MatrixXd x = ringing(0.2, 50.0);
  const Eigen::VectorXd e = noise(engine);
  const double prior = 0.7;
  const double gram = prior * prior * x.squaredNorm(), b = prior * x.col(0).dot(e);
  const double expected = 0.5 * b * b / (1.0 + gram) - 0.5 * std::log1p(gram);
  const Eigen::MatrixXd none(kRows, 0);
  EXPECT_NEAR(Scorer(e, none, 1.0).score(tangent(x, prior)).log_bayes_factor, expected, 1e-9 * std::abs(expected));
  // An error twice as large, in twice the noise, gives as much evidence for an effect twice as large.
  EXPECT_NEAR(Scorer(2.0 * e, none, 4.0).score(tangent(2.0 * x, prior)).log_bayes_factor, expected,
              1e-9 * std::abs(expected));
}

TEST(Scores, GiveNothingToWhatIsAlreadyEstimated) {
  std::mt19937 engine(4);
  const Eigen::MatrixXd known = ringing(0.25, 40.0);
  const Eigen::VectorXd e = 3.0 * known.col(0) + noise(engine);
  const Score score = Scorer(e, known, 1.0).score(tangent(2.0 * known));
  EXPECT_EQ(score.log_bayes_factor, 0.0);
}

TEST(Scores, GiveEquivalentEffectsALargeCosine) {
  std::mt19937 engine(5);
  const Eigen::MatrixXd a = ringing(0.3, 30.0), b = ringing(0.3, 33.0), c = ringing(0.9, 30.0, 7);
  const Scorer scorer(a.col(0) + noise(engine), Eigen::MatrixXd(kRows, 0), 1.0);
  EXPECT_GT(scorer.score(tangent(a)).cosine_with(scorer.score(tangent(b))), 0.95);
  EXPECT_LT(scorer.score(tangent(a)).cosine_with(scorer.score(tangent(c))), 0.3);
}

TEST(LogMeanExp, SurvivesLargeNumbers) {
  EXPECT_NEAR(log_mean_exp({1e5, 1e5}), 1e5, 1e-9);
  EXPECT_NEAR(log_mean_exp({0.0, std::log(3.0)}), std::log(2.0), 1e-12);
}

// The mean of the p-values 0.5 and 0.001 is 0.2505, and that of 0 and 0.1 is 0.05.
TEST(AveragedZ, IsThatOfTheMeanPValue) {
  EXPECT_NEAR(averaged_z({0.0, 3.0902}), 0.6729, 1e-3);
  EXPECT_NEAR(averaged_z({1000.0, 1.2816}), 1.6449, 1e-3);
  EXPECT_NEAR(averaged_z({-1.0, -1.0}), -1.0, 1e-9);
  EXPECT_NEAR(averaged_z({40.0, 40.0}), 40.0, 1e-6);
  EXPECT_NEAR(averaged_z({-50.0, -50.0}), -50.0, 1e-6);
  EXPECT_NEAR(averaged_z({200.0, 300.0}), 200.0, 0.01);  // what is least unlikely counts
}

// The factor is the mean of k p^(k - 1) over k, and its own mean over p is 1.
TEST(LogBayesFactorOfTest, AveragesOverTheAlternatives) {
  constexpr int steps = 20000;
  for (const double z : {-20.0, -3.5, 0.0, 1.6449, 3.0902}) {
    const double p = normal_cdf(-z);
    double mean = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double k = (i + 0.5) / steps;
      mean += k * std::pow(p, k - 1.0) / steps;
    }
    EXPECT_NEAR(std::exp(log_bayes_factor_of_test(z)), mean, 1e-6 * mean) << z;
  }
  EXPECT_NEAR(std::exp(log_bayes_factor_of_test(1.6449)), 1.7834, 1e-3);  // (0.95 + 0.05 log 0.05) / (0.05 log^2 0.05)
  EXPECT_NEAR(log_bayes_factor_of_test(29.999), log_bayes_factor_of_test(30.001), 0.1);  // on either side of the asymptote
  EXPECT_NEAR(log_bayes_factor_of_test(1000.0), 5e5, 100.0);
}

TEST(BelievedGain, IsNoMoreThanTheWholeEvidenceOrWhatTheModesOrTheTestShow) {
  const double of_test = log_bayes_factor_of_test(2.5);
  EXPECT_EQ(believed_gain(100.0, 20.0, 2.5), 20.0);
  EXPECT_EQ(believed_gain(15.0, 20.0, 2.5), 15.0);
  EXPECT_EQ(believed_gain(100.0, -20.0, 2.5), of_test);
  EXPECT_EQ(believed_gain(-5.0, 20.0, 2.5), -5.0);
}

TEST(LogBayesFactorOfTest, IsOneOnAverageUnderTheHypothesis) {
  constexpr double step = 1e-3;
  double mean = 0.0;
  for (double z = -12.0; z < 12.0; z += step)
    mean += step * std::exp(log_bayes_factor_of_test(z) - 0.5 * z * z) / std::sqrt(2.0 * M_PI);
  EXPECT_NEAR(mean, 1.0, 0.02);  // its tail falls as slowly as 1 / z^2
}

TEST(LikelihoodRatio, HasThePValueOfChiSquared) {
  EXPECT_NEAR(likelihood_ratio_p_value(3.841, 1.0), 0.05, 1e-4);
  EXPECT_NEAR(likelihood_ratio_p_value(7.815, 3.0), 0.05, 1e-4);
  EXPECT_EQ(likelihood_ratio_p_value(-1.0, 2.0), 1.0);
}

}  // namespace
}  // namespace tissue_stiffness
