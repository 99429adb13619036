// The smoother is compared with Gaussian conditioning on everything at once.
#include "diagnosis/force_smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace tissue_stiffness {
namespace {

constexpr Eigen::Index kModes = 2, kRows = 3;
constexpr int kFrames = 7;

struct Problem {
  std::vector<ModalTransition> transitions;
  std::vector<FrameEvidence> evidence;
  Eigen::MatrixXd h;  ///< all rows of all frames per displacement of the modes at all frames
  Eigen::VectorXd e;
};

Problem draw(unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const auto random = [&](Eigen::Index rows, Eigen::Index columns) -> Eigen::MatrixXd {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(engine); });
  };
  Problem p;
  p.h = Eigen::MatrixXd::Zero(kRows * kFrames, kModes * kFrames);
  p.e = random(kRows * kFrames, 1);
  const ModalStep step(Eigen::Vector2d(4.0, 30.0), Eigen::Vector2d(0.3, 0.5), {});
  for (int k = 0; k < kFrames; ++k) {
    p.transitions.emplace_back(step, 0.1 + 0.02 * k, kModes, kModes);
    const Eigen::MatrixXd h = 30.0 * random(kRows, kModes);
    p.h.block(kRows * k, kModes * k, kRows, kModes) = h;
    const Eigen::VectorXd e = p.e.segment(kRows * k, kRows);
    p.evidence.push_back({h.transpose() * h, h.transpose() * e, e.squaredNorm()});
  }
  return p;
}

/// Returns the displacement of every frame from the first force and the steps that follow, by carrying units along.
Eigen::MatrixXd responses(const Problem& p) {
  Eigen::MatrixXd out(kModes * kFrames, kModes * (kFrames + 1));
  for (Eigen::Index unit = 0; unit < out.cols(); ++unit) {
    Eigen::ArrayXd q = Eigen::ArrayXd::Zero(kModes), v = q, f = q;
    if (unit < kModes) f[unit] = 1.0;
    for (int k = 0; k < kFrames; ++k) {
      const ModalTransition& t = p.transitions[static_cast<std::size_t>(k)];
      const Eigen::ArrayXd next = t.qq * q + t.qv * v + t.qf * f;
      v = t.vq * q + t.vv * v + t.vf * f;
      q = next;
      if (unit / kModes == k + 1) f[unit % kModes] += 1.0;
      out.col(unit).segment(kModes * k, kModes) = q.matrix();
    }
  }
  return out;
}

void compare_with_conditioning(const Eigen::Vector2d& level, const Eigen::Vector2d& walk) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Problem p = draw(seed);
    const ForcePrior prior{level, walk};
    const SmoothedForce smoothed = smooth_force(p.transitions, p.evidence, prior);
    const Eigen::MatrixXd of_forces = p.h * responses(p);
    Eigen::VectorXd std(kModes * (kFrames + 1));
    std << prior.level, prior.walk.replicate(kFrames, 1);
    const Eigen::MatrixXd scaled = of_forces * std.asDiagonal();
    const Eigen::MatrixXd s = Eigen::MatrixXd::Identity(p.e.size(), p.e.size()) + scaled * scaled.transpose();
    const Eigen::LLT<Eigen::MatrixXd> root(s);
    const double deviance = p.e.dot(root.solve(p.e)) + 2.0 * Eigen::MatrixXd(root.matrixL()).diagonal().array().log().sum();
    EXPECT_NEAR(smoothed.deviance, deviance, 1e-10 * deviance);
    const Eigen::VectorXd parts = std.cwiseAbs2().asDiagonal() * (of_forces.transpose() * root.solve(p.e));
    const Eigen::VectorXd displacement = responses(p) * parts;
    Eigen::VectorXd force = parts.head(kModes);
    for (int k = 0; k < kFrames; ++k) {
      force += parts.segment(kModes * (k + 1), kModes);  // acts from this frame on
      const auto frame = static_cast<std::size_t>(k);
      EXPECT_LT((smoothed.force[frame] - force).norm(), 1e-9 * parts.norm()) << k;
      EXPECT_LT((smoothed.displacement[frame] - displacement.segment(kModes * k, kModes)).norm(),
                1e-9 * displacement.norm());
    }
  }
}

TEST(ForceSmoother, IsGaussianConditioning) {
  compare_with_conditioning({0.7, 2.0}, {0.2, 0.5});
}

// The covariances are singular here.
TEST(ForceSmoother, IsGaussianConditioningOfForcesThatNeverChange) {
  compare_with_conditioning({0.7, 2.0}, {0.0, 0.0});
  compare_with_conditioning({0.0, 2.0}, {0.0, 0.5});
}

TEST(ForceSmoother, TransitionsCompose) {
  const ModalStep step(Eigen::Vector2d(4.0, 30.0), Eigen::Vector2d(0.3, 0.5), {});
  const ModalTransition half(step, 0.05, kModes, kModes), whole(step, 0.1, kModes, kModes);
  EXPECT_LT((half.qq * half.qq + half.qv * half.vq - whole.qq).abs().maxCoeff(), 1e-13);
  EXPECT_LT((half.qq * half.qf + half.qv * half.vf + half.qf - whole.qf).abs().maxCoeff(), 1e-13);
  EXPECT_LT((whole.vf - whole.qv).abs().maxCoeff(), 1e-13) << "a constant force is a row of impulses";
}

TEST(ForceSmoother, NeedsNoForceForNoise) {
  const Problem p = draw(3);
  EXPECT_TRUE((likeliest_force_prior(p.transitions, p.evidence, 1.0).level.array() == 0.0).all());
}

}  // namespace
}  // namespace tissue_stiffness
