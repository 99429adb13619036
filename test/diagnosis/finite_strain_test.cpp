// A recording of large motions is fitted as what it is.
#include <gtest/gtest.h>

#include "../box_model.hpp"
#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "verification/experiment.hpp"

namespace tissue_stiffness {
namespace {

// The linear form of this bar swings at another frequency, so a scan of it ends at another modulus.
TEST(DiagnosisOfFiniteStrain, FitsTheGivenModelToLargeMotions) {
  constexpr double kTruth = 20e3;
  const auto bar = [](const std::string& modulus, const std::string& rest) {
    return box_settings(
        {"inertia: {density: 1000}", "elasticity: {law: neo_hookean, poisson_ratio: 0.45, young_modulus: " + modulus + "}",
         "fixed: {region: clamp}", "gravity: {acceleration: [6, 1, -4]}", "viscous_damping: {beta: 4.0e-3}"},
        "[{vertices: {topic: /vertices, noise: 3.0e-4}}]", rest);
  };
  const Experiment experiment(bar("{prior: 20e3, factor: 2}", "time: {step: 1.0e-3}\n"), bar_mesh(), {kTruth});
  Recording recording;
  recording.frames = see_all(experiment, experiment.film(0.0, 0.033, 45), 3e-4, 1);
  const Diagnosis d = diagnose(bar("{prior: 30e3, factor: 2}", ""), bar_mesh(), recording, {});
  EXPECT_NE(d.verdict, Verdict::unexplained);
  EXPECT_LT(d.z, 3.0);
  EXPECT_NEAR(d.steps.front().parameters.at("elasticity.young_modulus") / kTruth, 1.0, 0.01);
}

}  // namespace
}  // namespace tissue_stiffness
