// What the model lacks, physics or resolution, must not pass for certainty.
#include <gtest/gtest.h>

#include <algorithm>

#include "bar.hpp"
#include "tissue_stiffness/meshing/refine.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 20e3;

ModelSettings assessed(ModelSettings settings) {
  settings.mesh.discretisation_error = true;
  return settings;
}

TEST(MissingDamping, DoesNotBiasTheModulus) {
  const TetMesh mesh = bar_mesh();
  const double beta = 8e-3;  // a tenth of critical in the first mode: the ringing dies within the recording
  std::vector<std::string> damped = bar_under_gravity(prior(kTruth, 3));
  damped.push_back("viscous_damping: {beta: " + std::to_string(beta) + "}");
  const Experiment bar(box_settings(damped), mesh, {kTruth});
  const std::vector<Frame> frames = see_all(bar, bar.film(0.0, kFilmed, 100), kNoise, 3);
  Estimator estimator(box_settings(bar_under_gravity(prior(2.0 * kTruth, 3))), mesh);
  const StepResult last = step_through(estimator, frames);
  const ParameterEstimate& e = last.estimate.parameters.front();
  std::printf("%.0f Pa, truth %.0f, 95 %% %.0f..%.0f\n", e.mean, kTruth, e.lower95, e.upper95);
  EXPECT_NEAR(e.mean / kTruth, 1.0, 0.03);
  // The misfit is that of the free run: what is missing stays visible.
  double worst = 0.0;
  for (const Misfit& misfit : estimator.free_run()) worst = std::max(worst, misfit.rms_sigma);
  EXPECT_GT(worst, 5.0);
}

TEST(MissingNothing, LeavesTheFreeRunInCharge) {
  const TetMesh mesh = bar_mesh();
  const Experiment bar(box_settings(bar_under_gravity(prior(kTruth, 3))), mesh, {kTruth});
  Estimator estimator(box_settings(bar_under_gravity(prior(2.0 * kTruth, 3))), mesh);
  const StepResult last = step_through(estimator, see_all(bar, bar.film(0.0, kFilmed, 100), kNoise, 4));
  EXPECT_LT(last.estimate.parameters.front().std / kTruth, 1e-3);  // a corrected run knows ten times less
  EXPECT_TRUE(holds(last.estimate.parameters.front(), kTruth));
}

TEST(CoarseMesh, IsCorrectedForAndWidensTheInterval) {
  const TetMesh coarse = bar_mesh(8, 2, 2);
  const TetMesh fine = refine(coarse);
  const ModelSettings model = box_settings(bar_under_gravity(prior(kTruth, 3)));
  const Experiment bar(model, fine, {kTruth});
  std::vector<int> ids(static_cast<std::size_t>(coarse.corner_count));
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<int>(i);
  std::mt19937 engine(5);
  std::vector<Frame> frames;
  for (const auto& moment : bar.film(0.0, kFilmed, 60)) frames.push_back(see_vertices(bar, moment, ids, kNoise, engine));
  Estimator plain(model, coarse), honest(assessed(model), coarse);
  step_through(plain, frames);
  const StepResult last = step_through(honest, frames);
  const double bias = value(plain) / kTruth - 1.0, rest = value(honest) / kTruth - 1.0;
  std::printf("mesh error: %+.3f %% before, %+.3f %% after correction\n", 100.0 * bias, 100.0 * rest);
  EXPECT_FALSE(holds(plain.estimate().parameters.front(), kTruth));
  EXPECT_TRUE(holds(last.estimate.parameters.front(), kTruth));
  EXPECT_LT(std::abs(rest), 0.3 * std::abs(bias));
}

}  // namespace
}  // namespace tissue_stiffness
