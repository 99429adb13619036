#include "tissue_stiffness/diagnosis/scores.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tissue_stiffness {
namespace {

constexpr Eigen::Index kFrames = 80, kRowsEach = 30, kRows = kFrames * kRowsEach;

std::vector<Eigen::Index> offsets() {
  std::vector<Eigen::Index> out;
  for (Eigen::Index t = 0; t <= kFrames; ++t) out.push_back(t * kRowsEach);
  return out;
}

// Independent in space; in time an autoregression with coefficient `memory`, of unit variance.
Eigen::VectorXd noise(std::mt19937& engine, double memory) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd e(kRows);
  for (Eigen::Index r = 0; r < kRows; ++r) {
    const double fresh = normal(engine);
    e[r] = r < kRowsEach ? fresh : memory * e[r - kRowsEach] + std::sqrt(1.0 - memory * memory) * fresh;
  }
  return e;
}

// A motion of the whole body that rings at `frequency` and dies over `life` frames.
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
  const Eigen::VectorXd e = 2.5 * x.col(0) + noise(engine, 0.0);
  const Score score = Scorer(e, Eigen::MatrixXd(kRows, 0), offsets(), 1.0).score(tangent(x));
  const double std = 1.0 / x.norm();
  EXPECT_NEAR(score.amplitude[0], 2.5, 4.0 * std);
  EXPECT_NEAR(score.explained, 6.25 * x.squaredNorm() / e.squaredNorm(), 0.05);
  EXPECT_NEAR(score.size, 2.5 * x.norm() / std::sqrt(static_cast<double>(kRows)), 0.1);
  EXPECT_LT(score.p_value, 1e-6);
  EXPECT_GT(score.log_bayes_factor, 100.0);
}

TEST(Scores, LogBayesFactorIsTheClosedFormOfOneColumn) {
  std::mt19937 engine(3);
  const Eigen::MatrixXd x = ringing(0.2, 50.0);
  const Eigen::VectorXd e = noise(engine, 0.0);
  const double prior = 0.7;
  const double gram = prior * prior * x.squaredNorm(), b = prior * x.col(0).dot(e);
  const double expected = 0.5 * b * b / (1.0 + gram) - 0.5 * std::log1p(gram);
  const Score score = Scorer(e, Eigen::MatrixXd(kRows, 0), offsets(), 1.0).score(tangent(x, prior));
  EXPECT_NEAR(score.log_bayes_factor, expected, 1e-9 * std::abs(expected));
}

TEST(Scores, GiveNothingToWhatIsAlreadyEstimated) {
  std::mt19937 engine(4);
  const Eigen::MatrixXd known = ringing(0.25, 40.0);
  const Eigen::VectorXd e = 3.0 * known.col(0) + noise(engine, 0.0);
  const Score score = Scorer(e, known, offsets(), 1.0).score(tangent(2.0 * known));
  EXPECT_EQ(score.log_bayes_factor, 0.0);
  EXPECT_EQ(score.p_value, 1.0);
}

TEST(Scores, SeeTwinsAsTwins) {
  std::mt19937 engine(5);
  const Eigen::MatrixXd a = ringing(0.3, 30.0), b = ringing(0.3, 33.0), c = ringing(0.9, 30.0, 7);
  const Scorer scorer(a.col(0) + noise(engine, 0.0), Eigen::MatrixXd(kRows, 0), offsets(), 1.0);
  EXPECT_GT(scorer.score(tangent(a)).cosine_with(scorer.score(tangent(b))), 0.95);
  EXPECT_LT(scorer.score(tangent(a)).cosine_with(scorer.score(tangent(c))), 0.3);
}

struct Errors {
  double life;      // of the tangent [frames]
  double memory;    // of each row's error
  double together;  // rms of an error that all rows share along the tangent's shape, with a memory of 0.9 [sigma]
  double most;      // share of p-values below 5 %
};

class PValues : public testing::TestWithParam<Errors> {};

// The p-value must mean what it says whether or not the errors are correlated, in time and in space, and however short the
// effect acts; a naive one does not.
TEST_P(PValues, AreCalibrated) {
  const Errors& errors = GetParam();
  const Eigen::MatrixXd x = ringing(0.15, errors.life), shared = ringing(M_PI / 2.0, 1e9);
  std::mt19937 engine(6);
  int below = 0, naive = 0;
  const int draws = 1000;
  for (int k = 0; k < draws; ++k) {
    Eigen::VectorXd e = noise(engine, errors.memory);
    const Eigen::VectorXd course = noise(engine, 0.9);
    for (Eigen::Index t = 0; t < kFrames; ++t) {
      e.segment(t * kRowsEach, kRowsEach) +=
          errors.together * course[t * kRowsEach] * shared.block(kRowsEach, 0, kRowsEach, 1);
    }
    const Score score = Scorer(e, Eigen::MatrixXd(kRows, 0), offsets(), 1.0).score(tangent(x));
    below += score.p_value < 0.05 ? 1 : 0;
    naive += std::abs(score.amplitude[0]) * x.norm() > 1.96 ? 1 : 0;
  }
  std::printf("p < 5 %% in %.1f %% of draws, naively %.1f %%\n", 100.0 * below / draws, 100.0 * naive / draws);
  EXPECT_GT(below, 0.03 * draws);
  EXPECT_LT(below, errors.most * draws);
}

INSTANTIATE_TEST_SUITE_P(Errors, PValues,
                         testing::Values(Errors{200.0, 0.0, 0.0, 0.07}, Errors{200.0, 0.6, 0.0, 0.07},
                                         Errors{200.0, 0.9, 0.0, 0.07}, Errors{8.0, 0.0, 0.0, 0.07},
                                         Errors{8.0, 0.6, 0.0, 0.07}, Errors{200.0, 0.3, 0.1, 0.12},
                                         Errors{8.0, 0.3, 0.1, 0.12}));

TEST(Scores, PValuesIgnoreComponentsThatSayNothingOfTheirOwn) {
  std::mt19937 engine(10);
  const Eigen::VectorXd e = noise(engine, 0.0);
  const Scorer scorer(e, Eigen::MatrixXd(kRows, 0), offsets(), 1.0);
  const Eigen::MatrixXd one = ringing(0.15, 200.0);
  Eigen::MatrixXd three = Eigen::MatrixXd::Zero(kRows, 3);  // one, its double, and nothing
  three.col(0) = one;
  three.col(1) = 2.0 * one;
  EXPECT_NEAR(scorer.score(tangent(three)).p_value, scorer.score(tangent(one)).p_value, 1e-6);
}

// Of three directions, and of many ways that look alike, with an error of unknown sign that is allowed for.
TEST(Scores, PValuesOfVectorsOfWaysAndUnderDoubtAreCalibrated) {
  std::mt19937 engine(8);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd vector(kRows, 3);
  for (unsigned k = 0; k < 3; ++k) vector.col(k) = ringing(0.15 + 0.02 * k, 200.0, k + 1);
  const Eigen::VectorXd doubt = 0.3 * ringing(0.15, 150.0).col(0);
  int below[3] = {0, 0, 0};
  const int draws = 600;
  for (int k = 0; k < draws; ++k) {
    const Eigen::VectorXd e = noise(engine, 0.3);
    const Scorer scorer(e, Eigen::MatrixXd(kRows, 0), offsets(), 1.0);
    below[0] += scorer.score(tangent(vector)).p_value < 0.05 ? 1 : 0;
    std::vector<Score> ways;
    for (int way = 0; way < 12; ++way) ways.push_back(scorer.score(tangent(ringing(0.1 + 0.02 * way, 200.0))));
    std::vector<const Score*> all;
    for (const Score& way : ways) all.push_back(&way);
    below[1] += combined_p_value(all) < 0.05 ? 1 : 0;
    const Scorer doubtful(e + normal(engine) * doubt, Eigen::MatrixXd(kRows, 0), offsets(), 1.0, doubt);
    below[2] += doubtful.score(tangent(ringing(0.15, 200.0))).p_value < 0.05 ? 1 : 0;
  }
  for (const int count : below) {
    std::printf("p < 5 %% in %.1f %% of draws\n", 100.0 * count / draws);
    EXPECT_GT(count, 0.01 * draws);
    EXPECT_LT(count, 0.10 * draws);
  }
}

Score way(double p_value, const Eigen::Vector3d& direction) {
  Score out;
  out.p_value = p_value;
  out.direction = direction;
  return out;
}

TEST(CombinedPValue, CountsOnlyWaysThatLookDifferent) {
  const Score x = way(0.03, {1, 0, 0}), same = way(0.04, {1, 0, 0}), y = way(0.5, {0, 1, 0}), none = way(1e-9, {0, 0, 0});
  EXPECT_EQ(combined_p_value({}), 1.0);
  EXPECT_NEAR(combined_p_value({&x}), 0.03, 1e-12);
  EXPECT_NEAR(combined_p_value({&x, &none}), 0.03, 1e-12);
  EXPECT_NEAR(combined_p_value({&x, &same}), 0.03, 1e-12);
  EXPECT_NEAR(combined_p_value({&x, &y}), 1.0 - 0.97 * 0.97, 1e-12);
  const Score sure = way(1e-40, {1, 0, 0});
  EXPECT_NEAR(combined_p_value({&sure, &y}), 2e-40, 1e-44);
}

// Whether or not the frames' gains are correlated.
TEST(PredictionPValue, IsCalibratedAndSeesABetterModel) {
  EXPECT_EQ(prediction_p_value(Eigen::VectorXd(0)), 1.0);
  for (const double memory : {0.0, 0.6}) {
    std::mt19937 engine(9);
    int below = 0, better = 0;
    const int draws = 2000;
    for (int k = 0; k < draws; ++k) {
      const Eigen::VectorXd e = noise(engine, memory);
      const Eigen::VectorXd gains = Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<kRowsEach>>(e.data(), kFrames);
      below += prediction_p_value(gains) < 0.05 ? 1 : 0;
      better += prediction_p_value(gains.array() + 3.0) < 0.05 ? 1 : 0;
    }
    std::printf("memory %.1f: p < 5 %% in %.1f %% of draws\n", memory, 100.0 * below / draws);
    EXPECT_GT(below, 0.03 * draws);
    EXPECT_LT(below, 0.09 * draws);
    EXPECT_GT(better, 0.99 * draws);
  }
}

TEST(LogMeanExp, SurvivesLargeNumbers) {
  EXPECT_NEAR(log_mean_exp({1e5, 1e5}), 1e5, 1e-9);
  EXPECT_NEAR(log_mean_exp({0.0, std::log(3.0)}), std::log(2.0), 1e-12);
}

}  // namespace
}  // namespace tissue_stiffness
