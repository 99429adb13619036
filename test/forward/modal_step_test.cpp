// The closed form of a mode's step against the matrix exponential, which two steps with a branch of no weight take.
#include "forward/modal_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tissue_stiffness {
namespace {

// From slow to fast, from free to critically damped and beyond.
const Eigen::VectorXd kSquares = (Eigen::VectorXd(8) << 0.0, 1.0, 1e2, 1e3, 1e4, 1e4, 1e4, 1e7).finished();
const Eigen::VectorXd kDampings = (Eigen::VectorXd(8) << 0.5, 0.0, 3.0, 0.0, 10.0, 199.0, 900.0, 2e3).finished();

TEST(ModalStep, IsTheExponentialOfTheAugmentedSystem) {
  const Eigen::Index n = kSquares.size();
  const Eigen::VectorXd before = Eigen::VectorXd::LinSpaced(n, -3.0, 4.0), after = before.reverse();
  for (const double step : {1e-4, 4e-3, 1.0 / 30.0, 0.3}) {
    ModalStep closed(kSquares, kDampings, {}), general(kSquares, kDampings, {{0.0, 0.2}});
    Eigen::MatrixXd state = Eigen::MatrixXd::Zero(n, 2), same = Eigen::MatrixXd::Zero(n, 3);
    state.col(0) = same.col(0) = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0).cwiseQuotient((1.0 + kSquares.array()).matrix());
    state.col(1) = same.col(1) = Eigen::VectorXd::LinSpaced(n, -1.0, 1.0);
    closed.advance(step, before, after, state);
    general.advance(step, before, after, same);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double size = same.row(k).head(2).norm() + step * (before.cwiseAbs()[k] + 1.0);
      EXPECT_NEAR(state(k, 0), same(k, 0), 1e-12 * size) << "omega^2 " << kSquares[k] << ", step " << step;
      EXPECT_NEAR(state(k, 1), same(k, 1), 1e-11 * size) << "omega^2 " << kSquares[k] << ", step " << step;
    }
  }
}

TEST(ModalStep, IsTheSameInOneStepAndInMany) {
  const Eigen::Index n = kSquares.size();
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(n), force = Eigen::VectorXd::Ones(n);
  ModalStep one(kSquares, kDampings, {}), many(kSquares, kDampings, {});
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(n, 2), same = state;
  one.advance(0.2, none, force, state);
  for (int k = 0; k < 100; ++k) many.advance(0.002, k / 100.0 * force, (k + 1) / 100.0 * force, same);
  EXPECT_LT((state - same).cwiseAbs().maxCoeff(), 1e-11);
}

}  // namespace
}  // namespace tissue_stiffness
