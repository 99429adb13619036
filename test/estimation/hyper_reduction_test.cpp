// Estimates of finite strain go on in few vectors, and say what that leaves out.
#include "estimation/hyper_reduction.hpp"

#include <gtest/gtest.h>

#include "bar.hpp"
#include "forward/full_model.hpp"
#include "forward/hyper_reduced_model.hpp"
#include "observation/observation_operator.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 40e3, kInterval = 0.04;  // [Pa], [s]

std::vector<std::string> swinging(const std::string& young_modulus) {
  return {"inertia: {density: 1000}",
          "elasticity: {law: neo_hookean, poisson_ratio: 0.45, young_modulus: " + young_modulus + "}",
          "fixed: {region: clamp}", "gravity: {acceleration: [0.5, 1, -3]}", "mass_damping: {alpha: 1}"};
}

class HyperReductionOfABar : public testing::Test {
 protected:
  HyperReductionOfABar()
      : settings_(box_settings(swinging(prior(1.3 * kTruth, 2.0)))),
        mesh_(bar_mesh(6, 2, 2)),
        model_(settings_, mesh_),
        operators_(make_observation_operators(model_)) {
    const Experiment truth(settings_, mesh_, {kTruth});
    frames_ = see_all(truth, truth.film(0.0, kInterval, 30), kNoise, 3);
  }

  Eigen::VectorXd at(double modulus) const {
    return Eigen::VectorXd::Constant(1, model_.parameters().free().front().to_coordinate(modulus));
  }
  ReductionQuestion question(double modulus) const {
    const Eigen::VectorXd std = model_.parameters().prior_std(), spread = 0.05 * std;
    Eigen::MatrixXd points(1, 3);
    points << at(modulus), at(modulus) + spread, at(modulus) - spread;
    return {at(modulus), points, spread, std, 0.0};
  }

  ModelSettings settings_;
  TetMesh mesh_;
  Model model_;
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
  std::vector<Frame> frames_;
};

TEST_F(HyperReductionOfABar, EstimatesTheModulusOfRunsInFull) {
  Estimator estimator(settings_, mesh_);
  estimator.set_first_stamp(0.0);
  EXPECT_EQ(estimator.description().front().rfind("full:", 0), 0U);
  step_through(estimator, frames_);
  EXPECT_EQ(estimator.description().front().rfind("hyper-reduced:", 0), 0U) << estimator.description().front();
  ASSERT_TRUE(estimator.basis_error().has_value());
  EXPECT_LT(*estimator.basis_error(), kNoise);
  EXPECT_NEAR(value(estimator), kTruth, 5e-3 * kTruth);
  const ParameterEstimate& modulus = estimator.estimate().parameters.front();
  EXPECT_TRUE(holds(modulus, kTruth)) << modulus.mean << ", " << modulus.lower95 << " to " << modulus.upper95 << " Pa";
}

// A model that was trained with nothing but the first frames is trained again where it is not good enough.
TEST_F(HyperReductionOfABar, ChecksAModelAgainstTheRunInFull) {
  const std::shared_ptr<ForwardModel> full = make_forward_model(model_);
  const std::vector<Frame> first(frames_.begin(), frames_.begin() + 4);
  const HyperReduction early = hyper_reduce({model_, *full, operators_, first, {0.0}}, full, question(kTruth));
  ASSERT_TRUE(early.error.has_value());
  EXPECT_LE(*early.error, kHyperShare * kNoise);
  const HyperReduction later =
      hyper_reduce({model_, *early.forward, operators_, frames_, {0.0}}, early.forward, question(kTruth));
  ASSERT_TRUE(later.error.has_value());
  EXPECT_LT(*later.error, kNoise);
  EXPECT_GT(*later.error, 0.0);
  const HyperReduction again =
      hyper_reduce({model_, *later.forward, operators_, frames_, {0.0}}, later.forward, question(kTruth));
  if (*later.error <= kHyperShare * kNoise) {
    EXPECT_EQ(again.forward, later.forward) << "trained again without need";
  }
  EXPECT_EQ(in_full(later.forward)->description(), full->description());
  EXPECT_EQ(in_full(full), full);
}

// Explicit steps have a lumped mass, so that no reduced model agrees with them.
TEST_F(HyperReductionOfABar, LeavesExplicitRunsInFull) {
  const Experiment truth(settings_, mesh_, {kTruth});
  const std::vector<Frame> fast = see_all(truth, truth.film(0.0, 2e-3, 6), kNoise, 3);
  const std::shared_ptr<ForwardModel> full = make_forward_model(model_);
  const HyperReduction stays = hyper_reduce({model_, *full, operators_, fast, {0.0}}, full, question(kTruth));
  EXPECT_EQ(stays.forward, full);
  EXPECT_FALSE(stays.error.has_value());
  EXPECT_EQ(stays.shift.size(), 0);
}

}  // namespace
}  // namespace tissue_stiffness
