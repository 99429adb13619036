// A cheap model is shifted to agree with an accurate one.
#include "fit/corrected_surrogate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "../box_model.hpp"
#include "forward/full_model.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {
namespace {

class CorrectedSurrogateTest : public ::testing::Test {
 protected:
  CorrectedSurrogateTest() : full_(model_, FullModel::Options()), reduced_(model_, linear()) {
    for (int k = 1; k <= 20; ++k) times_.push_back(0.02 * k);
  }
  static BasisOptions linear() {
    BasisOptions options;
    options.nonlinear = BasisOptions::Nonlinear::left_out;
    return options;
  }
  Eigen::VectorXd theta(double deviations) const {
    return model_.parameters().theta(model_.parameters().prior_mean() + deviations * model_.parameters().prior_std());
  }
  CorrectedSurrogate at(double deviations) const {
    CorrectedSurrogate out(full_, reduced_);
    out.anchor(theta(deviations), 0.0, times_);
    return out;
  }
  // Returns the distance from the accurate run at `deviations`, over its motion.
  double error(const ForwardModel& forward, double deviations) const {
    const auto a = full_.start(theta(deviations), 0.0), b = forward.start(theta(deviations), 0.0);
    double off = 0.0, motion = 0.0;
    for (const double time : times_) {
      a->advance(time);
      b->advance(time);
      off += (a->displacement() - b->displacement()).squaredNorm();
      motion += a->displacement().squaredNorm();
    }
    return std::sqrt(off / motion);
  }

  const TetMesh mesh_ = bar_mesh(4);
  const Model model_{
      box_settings({"inertia: {density: 1000}",
                    "elasticity: {law: linear, poisson_ratio: 0.4, young_modulus: {prior: 6.0e4, factor: 1.5}}",
                    "fixed: {region: clamp}", "gravity: {acceleration: [0, 0, -9.81]}", "mass_damping: {alpha: 2}",
                    "geometric_nonlinearity: {share: 1}"}),
      mesh_};
  const FullModel full_;
  const ReducedModel reduced_;
  std::vector<double> times_;
};

TEST_F(CorrectedSurrogateTest, AgreesAtItsAnchor) {
  EXPECT_GT(error(reduced_, 0.1), 0.03);  // there is a difference to correct
  EXPECT_LT(error(at(0.1), 0.1), 1e-9);
}

TEST_F(CorrectedSurrogateTest, FollowsTheLineThroughTheAnchorBefore) {
  const CorrectedSurrogate before = at(0.0), alone = at(0.3);
  CorrectedSurrogate both = at(0.3);
  both.follow(before, (theta(1.0) - theta(0.0)).cwiseAbs());
  EXPECT_LT(error(both, 0.3), 1e-9);
  for (const double deviations : {0.2, 0.4}) {
    std::printf("off by %.2e with one anchor, by %.2e with two\n", error(alone, deviations), error(both, deviations));
    EXPECT_LT(error(both, deviations), 0.5 * error(alone, deviations)) << deviations;
  }
  // Far away it keeps the change of one move.
  EXPECT_LT(error(both, 2.0), 1.5 * error(alone, 2.0));
}

}  // namespace
}  // namespace tissue_stiffness
