// Effects that a reduced basis must be prepared for: the reduced model against the full one, at the prior and away from it.
#include <gtest/gtest.h>

#include <cmath>

#include "../box_model.hpp"
#include "full_against_reduced.hpp"

namespace tissue_stiffness {
namespace {

std::vector<std::string> bar_with(const std::vector<std::string>& more) {
  std::vector<std::string> effects{
      "inertia: {density: 1000}",
      "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: {prior: 3.0e4, factor: 2}}", "fixed: {region: clamp}",
      "gravity: {acceleration: [0.5, 1, -2]}"};
  effects.insert(effects.end(), more.begin(), more.end());
  return effects;
}

// Error of the reduced model where each estimated parameter (behind the modulus) takes the given values in turn.
double worst(const std::vector<std::string>& effects, const std::vector<Eigen::VectorXd>& values, double step = 2e-4) {
  const TetMesh mesh = bar_mesh(4);
  Model model(box_settings(bar_with(effects)), mesh);
  model.loads().set_first_stamp(0.1);
  const ReducedModel reduced(model);
  double error = 0.0;
  for (const Eigen::VectorXd& value : values) {
    Eigen::VectorXd w = model.parameters().prior_mean();
    for (Eigen::Index i = 0; i < value.size(); ++i) {
      w[i + 1] = model.parameters().free()[static_cast<std::size_t>(i + 1)].to_coordinate(value[i]);
    }
    const double here = full_against_reduced(model, reduced, model.parameters().theta(w), step);
    std::printf("%s at %g: %.1e of the motion\n", effects.front().c_str(), value[0], here);
    error = std::max(error, here);
  }
  return error;
}

Eigen::VectorXd at(std::initializer_list<double> values) {
  Eigen::VectorXd v(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), v.data());
  return v;
}

TEST(ReducedEffects, ViscoelasticityIsExactInTime) {
  EXPECT_LT(worst({"viscoelasticity: {gamma: {mean: 0, std: 0.5}, tau: {prior: 0.02, factor: 3}}"},
                  {at({0.0, 0.02}), at({0.5, 0.005}), at({1.0, 0.02}), at({0.3, 0.5})}),
            1e-3);
}

TEST(ReducedEffects, SeveralBranchesAddUp) {
  EXPECT_LT(worst({"viscoelasticity: {gamma: {mean: 0, std: 0.5}, tau: 0.01}",
                   "viscoelasticity: {gamma: {mean: 0, std: 0.5}, tau: 0.1}"},
                  {at({0.4, 0.6})}),
            1e-3);
}

TEST(ReducedEffects, AClampIsCompliant) {
  EXPECT_LT(worst({"elastic_support: {region: clamp, compliance: {mean: 0, std: 1.0e-7}}"},
                  {at({0.0}), at({1e-9}), at({1e-7}), at({1e-6})}),
            5e-3);
  EXPECT_LT(worst({"elastic_support: {region: clamp, compliance: {prior: 3.0e-7, factor: 3}}"},
                  {at({3e-8}), at({3e-7}), at({3e-6})}),
            2e-3);
}

TEST(ReducedEffects, AKnownComplianceNeedsNoPreparation) {
  EXPECT_LT(worst({"elastic_support: {region: clamp, compliance: 5.0e-7}", "mass_damping: {alpha: {mean: 0, std: 1}}"},
                  {at({0.0})}),
            1e-3);
}

TEST(ReducedEffects, AFoundationGrowsFromNothing) {
  EXPECT_LT(worst({"foundation: {region: top, stiffness: {mean: 0, std: 1.0e4}}"}, {at({0.0}), at({5e3}), at({5e4})}),
            2e-3);
}

TEST(ReducedEffects, GravityAndMassGrowFromNothing) {
  EXPECT_LT(worst({"gravity: {acceleration: {mean: [0, 0, 0], std: 3}}"}, {at({3.0, 5.0, 1.0})}), 1e-3);
  EXPECT_LT(worst({"added_mass: {region: tip, mass: {mean: 0, std: 0.01}}"}, {at({0.0}), at({0.01}), at({0.05})}), 2e-3);
}

TEST(ReducedEffects, FibresGrowFromNothingAndTurn) {
  const std::string head = "fibre_reinforcement: {direction: [1, 0, 0], modulus: {mean: 0, std: 2.0e4}, angle: ";
  EXPECT_LT(worst({head + "0.5}"}, {at({0.0}), at({1e4}), at({4e4})}), 2e-3);
  EXPECT_LT(worst({head + "{mean: 0.5, std: 0.3}}"}, {at({1e4, 0.2}), at({2e4, 0.5}), at({4e4, 0.9})}), 5e-3);
}

TEST(ReducedEffects, AnInclusionGrowsFromNothingAndWanders) {
  const std::string head = "stiff_inclusion: {excess: {mean: 0, std: 2}, ";
  EXPECT_LT(worst({head + "center: [0.03, 0.01, 0.01], radius: 0.012}"}, {at({0.0}), at({1.0}), at({4.0})}), 1e-2);
  EXPECT_LT(worst({head + "center: {mean: [0.03, 0.01, 0.01], std: 0.004}, radius: {prior: 0.012, factor: 1.3}}"},
                  {at({1.0, 0.03, 0.01, 0.01, 0.012}), at({3.0, 0.035, 0.012, 0.009, 0.014})}),
            2e-2);
}

// A lump's matrix changes with its place, so the vectors for one place are not those for another.
TEST(ReducedEffects, AHeavyLumpNeedsVectorsThatAreChosenAtItsPlace) {
  const TetMesh mesh = bar_mesh(8, 2, 2);
  const std::vector<std::string> effects =
      bar_with({"added_mass: {center: {mean: [0.03, 0.01, 0.01], std: 0.02}, mass: {prior: 0.002, factor: 4}}"});
  Model model(box_settings(effects), mesh);
  model.loads().set_first_stamp(0.1);
  const ParameterSpace& parameters = model.parameters();
  const auto place = [&](double x) {
    return parameters.coordinates({{"added_mass.mass", 0.05}, {"added_mass.center_x", x}}, parameters.prior_mean());
  };
  BasisOptions small;
  small.size = 12;
  small.per_part = 4;
  const auto error = [&](const BasisOptions& options) {
    return full_against_reduced(model, ReducedModel(model, options), parameters.theta(place(0.071)), 2e-4);
  };
  const double at_prior = error(small);
  small.around = place(0.07);
  const double wide = error(small);
  small.reach = 0.05 * parameters.prior_std();
  const double narrow = error(small);
  std::printf("a lump of 50 g: %.1e of the motion with the prior's vectors, %.1e with those of its place, %.1e near it\n",
              at_prior, wide, narrow);
  EXPECT_LT(wide, 0.5 * at_prior);
  EXPECT_LT(narrow, 0.5 * at_prior);
  EXPECT_NE(narrow, wide);
}

TEST(ReducedEffects, FibresContract) {
  EXPECT_LT(worst({"active_contraction: {direction: circumferential, amplitude: {mean: 0, std: 500}, "
                   "period: {prior: 0.2, factor: 1.5}, onset: {mean: 0.02, std: 0.02}, angle: {mean: 0.7, std: 0.3}}"},
                  {at({500.0, 0.2, 0.02, 0.7}), at({1500.0, 0.3, -0.03, 1.0})}),
            5e-3);
}

TEST(ReducedEffects, AShiftOfPoissonsRatio) {
  EXPECT_LT(worst({"compressibility: {shift: {mean: 0, std: 0.05}}"}, {at({-0.1}), at({0.03})}), 4e-3);
}

TEST(ReducedEffects, MassGrowsWithStiffness) {
  EXPECT_LT(worst({"period_elongation: {step_squared: {mean: 0, std: 1.0e-5}}", "mass_damping: {alpha: 1}",
                   "viscous_damping: {beta: 2.0e-3}", "viscoelasticity: {gamma: 0.3, tau: 0.05}"},
                  {at({0.0}), at({1e-5}), at({4e-5})}),
            1e-3);
}

// Newmark's average acceleration in long steps against exact modes of the grown mass.
TEST(ReducedEffects, PeriodElongationStandsForLongSteps) {
  const TetMesh mesh = bar_mesh(4);
  const auto left = [&](double h, double step_squared) {
    const Model stepped(box_settings(bar_with({})), mesh);
    const Model model(box_settings(bar_with({to_yaml(EffectEntry{"period_elongation", {{"step_squared", step_squared}}})})),
                      mesh);
    const double error =
        full_against_reduced(stepped, ReducedModel(model), model.parameters().theta(model.parameters().prior_mean()), h);
    std::printf("steps of %g s, step_squared %g: %.1e of the motion\n", h, step_squared, error);
    return error;
  };
  for (const double h : {0.008, 0.004}) {
    const double without = left(h, 0.0);
    EXPECT_GT(without, 1e-3);
    EXPECT_LT(left(h, h * h), 0.15 * without);
  }
}

}  // namespace
}  // namespace tissue_stiffness
