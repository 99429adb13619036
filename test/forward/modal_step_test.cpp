// The closed form and the spectrum of a mode's step against the matrix exponential.
#include "forward/modal_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

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

// Returns q, q', z... of mode k after a step, by the exponential of the system that is augmented by the force and its
// change.
Eigen::VectorXd by_exponential(Eigen::Index k, const std::vector<Relaxation>& branches, double step, double before,
                               double after, const Eigen::VectorXd& state) {
  const Eigen::Index n = state.size();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 2, n + 2);
  a(0, 1) = step;
  a(1, 0) = -kSquares[k] * step;
  a(1, 1) = -kDampings[k] * step;
  a(1, n) = step;
  a(n, n + 1) = 1.0;
  for (Eigen::Index i = 2; i < n; ++i) {
    const Relaxation& branch = branches[static_cast<std::size_t>(i - 2)];
    a(1, 0) -= branch.modulus * kSquares[k] * step;
    a(1, i) += branch.modulus * kSquares[k] * step;
    a(i, 0) = step / branch.time_constant;
    a(i, i) = -a(i, 0);
  }
  Eigen::VectorXd augmented(n + 2);
  augmented << state, before, after - before;
  return Eigen::MatrixXd(a.exp()).topRows(n) * augmented;
}

TEST(ModalStep, RelaxesAsTheExponentialOfTheAugmentedSystemDoes) {
  const Eigen::Index n = kSquares.size();
  const Eigen::VectorXd before = Eigen::VectorXd::LinSpaced(n, -3.0, 4.0), after = before.reverse();
  const std::vector<std::vector<Relaxation>> bodies = {
      {{0.5, 0.2}}, {{2.0, 1e-3}}, {{1e-6, 10.0}}, {{0.3, 0.01}, {0.6, 1.0}}, {{0.3, 0.1}, {0.6, 0.1}}};
  for (const std::vector<Relaxation>& branches : bodies) {
    for (const double step : {1e-4, 4e-3, 1.0 / 30.0, 0.3}) {
      ModalStep modal(kSquares, kDampings, branches);
      Eigen::MatrixXd state(n, modal.states());
      for (Eigen::Index j = 0; j < state.cols(); ++j) {
        const double scale = j == 1 ? 0.0 : 1.0;
        state.col(j) = (1.0 + 0.3 * static_cast<double>(j)) * (1.0 + scale * kSquares.array()).inverse();
      }
      const Eigen::MatrixXd at_start = state;
      modal.advance(step, before, after, state);
      for (Eigen::Index k = 0; k < n; ++k) {
        const Eigen::VectorXd wanted = by_exponential(k, branches, step, before[k], after[k], at_start.row(k).transpose());
        const double size = at_start.row(k).norm() + step * (std::abs(before[k]) + std::abs(after[k]));
        EXPECT_LT((state.row(k).transpose() - wanted).cwiseAbs().maxCoeff(), 1e-10 * size)
            << "omega^2 " << kSquares[k] << ", step " << step << ", " << branches.size() << " branches";
      }
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
