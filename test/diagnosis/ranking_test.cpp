#include "diagnosis/ranking.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tissue_stiffness {
namespace {

constexpr Eigen::Index kRows = 1200;

Eigen::MatrixXd normal_numbers(Eigen::Index columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(kRows, columns, [&] { return normal(engine); });
}

Candidate candidate(const std::string& effect, const Eigen::VectorXd& tangent) {
  return {effect, {}, {tangent, Eigen::VectorXd::Ones(1)}};
}

TEST(Rank, PutsWhatIsThereFirstWithItsBestCandidate) {
  const Eigen::MatrixXd x = normal_numbers(3, 1);
  const Eigen::VectorXd residual = normal_numbers(1, 2) + 0.5 * x.col(0);
  const std::vector<Candidate> candidates{candidate("absent", x.col(1)), candidate("there", x.col(0)),
                                          candidate("there", x.col(2))};
  const std::vector<Ranked> ranked = rank_effects({residual, Eigen::MatrixXd(kRows, 0), 1.0}, candidates);
  ASSERT_EQ(ranked.size(), 2U);
  EXPECT_EQ(ranked.front().effect, "there");
  EXPECT_EQ(&ranked.front().best(), &candidates[1]);
  EXPECT_GT(ranked.front().evidence, 100.0);
  EXPECT_LT(ranked.back().evidence, 0.0);
  EXPECT_NEAR(ranked.front().score().amplitude[0], 0.5, 0.1);
}

TEST(Rank, KeepsTheBestCandidateOfEachForm) {
  const Eigen::MatrixXd x = normal_numbers(3, 4);
  const Eigen::VectorXd residual = normal_numbers(1, 5) + 0.5 * x.col(0) + 0.3 * x.col(1);
  std::vector<Candidate> candidates{candidate("mass", x.col(0)), candidate("mass", x.col(1)), candidate("mass", x.col(2))};
  candidates[0].proposal.refine = {"mass", {{"region", "end"}, {"mass", 1.0}}};
  candidates[1].proposal.refine = {"mass", {{"center", Eigen::Vector3d(0.0, 0.0, 1.0)}, {"mass", 1.0}}};
  candidates[2].proposal.refine = {"mass", {{"center", Eigen::Vector3d(1.0, 0.0, 0.0)}, {"mass", 1.0}}};
  const Ranked ranked = rank_effects({residual, Eigen::MatrixXd(kRows, 0), 1.0}, candidates).front();
  ASSERT_EQ(ranked.forms.size(), 2U);
  EXPECT_EQ(ranked.forms[0].candidate, &candidates[0]);
  EXPECT_EQ(ranked.forms[1].candidate, &candidates[1]);
}

TEST(Rank, PutsAnAmplitudeOutOfItsBoundsLast) {
  const Eigen::MatrixXd x = normal_numbers(2, 3);
  Candidate damping = candidate("damping", x.col(0));
  damping.lower = 0.0;
  const std::vector<Candidate> candidates{damping, candidate("absent", x.col(1))};
  EXPECT_EQ(rank_effects({0.5 * x.col(0), Eigen::MatrixXd(kRows, 0), 1.0}, candidates).front().effect, "damping");
  EXPECT_EQ(rank_effects({-0.5 * x.col(0), Eigen::MatrixXd(kRows, 0), 1.0}, candidates).front().effect, "absent");
}

}  // namespace
}  // namespace tissue_stiffness
