#include "tissue_stiffness/diagnosis/ranking.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tissue_stiffness {
namespace {

constexpr Eigen::Index kFrames = 60, kRowsEach = 20, kRows = kFrames * kRowsEach;

Eigen::MatrixXd normal_numbers(Eigen::Index columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(kRows, columns, [&] { return normal(engine); });
}

Candidate candidate(const std::string& effect, const Eigen::VectorXd& tangent) {
  return {effect, {}, {tangent, Eigen::VectorXd::Ones(1)}};
}

Scorer scorer(const Eigen::VectorXd& residual) {
  std::vector<Eigen::Index> offsets;
  for (Eigen::Index t = 0; t <= kFrames; ++t) offsets.push_back(t * kRowsEach);
  return {residual, Eigen::MatrixXd(kRows, 0), offsets, 1.0};
}

TEST(Rank, DeclaresWhatIsThereAndAboveTheFloor) {
  const Eigen::MatrixXd x = normal_numbers(3, 1);
  const Scorer s = scorer(normal_numbers(1, 2) + 0.5 * x.col(0));
  const std::vector<Candidate> candidates{candidate("absent", x.col(1)), candidate("there", x.col(0)),
                                          candidate("there", x.col(2))};
  const std::vector<Ranked> ranked = rank(s, candidates, 0.0);
  ASSERT_EQ(ranked.size(), 2U);
  EXPECT_EQ(ranked.front().effect, "there");
  EXPECT_EQ(ranked.front().best, &candidates[1]);
  EXPECT_TRUE(ranked.front().declared);
  EXPECT_FALSE(ranked.back().declared);
  EXPECT_NEAR(ranked.front().score.amplitude[0], 0.5, 0.1);
  EXPECT_FALSE(rank(s, candidates, 1.0).front().declared) << "0.5 sigma are below a floor of 1";
}

// An amplitude that cannot be negative is seldom significant by chance: half as often to either side, never on the wrong
// one.
TEST(Rank, TestsOneSideOfWhatHasOneSign) {
  int below = 0, wrong = 0;
  const int draws = 400;
  for (int k = 0; k < draws; ++k) {
    const Eigen::MatrixXd x = normal_numbers(2, 100 + static_cast<unsigned>(k));
    Candidate damping = candidate("damping", x.col(0));
    damping.lower = 0.0;
    const Ranked ranked = rank(scorer(x.col(1)), {damping}, 0.0).front();
    below += ranked.p_value < 0.05 ? 1 : 0;
    wrong += ranked.p_value < 0.5 && ranked.score.amplitude[0] < 0.0 ? 1 : 0;
  }
  EXPECT_GT(below, 0.03 * draws);
  EXPECT_LT(below, 0.07 * draws);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace tissue_stiffness
