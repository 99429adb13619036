// Palpation: a ball whose place is known touches a block, and its force is measured.
#include <gtest/gtest.h>

#include <cmath>

#include "../block_model.hpp"
#include "bar.hpp"
#include "felt_forces.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 24e3, kForceNoise = 1e-3, kOffset = 1e-4;

ModelSettings palpation(const std::string& young_modulus, const std::string& mesh_error, const std::string& more = "",
                        const std::string& damping = "- viscous_damping: {beta: 0.01}\n") {
  const std::string text =
      "mesh: {file: block.vtk, boundary: faceted, discretisation_error: " + mesh_error +
      "}\n"
      "regions:\n"
      "  bottom: {box: {min: [-1, -1, -1], max: [1, 1, 1.0e-6]}}\n"
      "  top: {box: {min: [-1, -1, 0.019999], max: [1, 1, 1]}}\n"
      "effects:\n"
      "- inertia: {density: 1000}\n"
      "- fixed: {region: bottom}\n"
      "- elasticity: {law: linear, poisson_ratio: 0.4, young_modulus: " +
      young_modulus + "}\n" + damping +
      "- tool_contact: {region: top, topic: /pose, center: [0, 0, 0.01], radius: {value: 0.01, tolerance: 0}" + more +
      "}\n"
      "observations: [{reaction: {topic: /force, region: top, noise: 1.0e-3, gain: 0.005, bias: 1.0e-3}}]\n";
  return read_model(parse_yaml(text, "model.yaml"), "");
}

// The ball's lowest point goes 2 mm deep within a quarter of a second. `offset`: how much lower it is than the pose says.
std::vector<LoadSample> poses(double offset = 0.0) {
  std::vector<LoadSample> out;
  for (double t = 0.0; t < 1.2; t += 0.01) {
    const double deep = 0.0012 * (1.0 - std::cos(4.0 * M_PI * t));
    out.push_back({"/pose", t, pose_values(Eigen::Isometry3d(Eigen::Translation3d(0.01, 0.01, 0.0204 - deep - offset)))});
  }
  return out;
}

std::vector<Frame> felt(const TetMesh& mesh, double offset = 0.0, int count = 9) {
  Model model(palpation(std::to_string(kTruth), "false"), mesh);
  model.loads().drive(0.0, poses(offset));
  return felt_forces(model, 0.002, 0.06, count, kForceNoise);
}

Estimate estimate(const ModelSettings& settings, const TetMesh& mesh, const std::vector<Frame>& frames) {
  Estimator estimator(settings, mesh);
  estimator.set_first_stamp(0.0);
  for (const LoadSample& sample : poses()) estimator.add_load(sample);
  estimator.replay(frames);
  const ParameterEstimate e = estimator.estimate().parameters.at(0);
  std::printf("E %.1f (%.1f to %.1f) of %.1f, %s\n", e.mean, e.lower95, e.upper95, kTruth,
              estimator.estimate().state_reason.c_str());
  return estimator.estimate();
}

ParameterEstimate estimated(const ModelSettings& settings, const TetMesh& mesh, const std::vector<Frame>& frames) {
  return estimate(settings, mesh, frames).parameters.at(0);
}

TEST(Palpation, TheForceAtAToolTellsTheModulus) {
  const TetMesh mesh = block_mesh();
  ModelSettings settings = palpation(prior(60e3, 3), "false");
  settings.exact_inputs = true;
  const ParameterEstimate e = estimated(settings, mesh, felt(mesh));
  EXPECT_NEAR(e.mean, kTruth, 0.005 * kTruth);
  EXPECT_LT(e.upper95 / e.lower95, 1.02);
}

// A tool that is 0.1 mm lower than its pose says presses harder: the tolerance of `offset` is what the interval needs.
TEST(Palpation, TheIntervalHoldsTheToleranceOfTheToolsPlace) {
  const TetMesh mesh = block_mesh();
  const Estimate last = estimate(palpation(prior(60e3, 3), "false"), mesh, felt(mesh, kOffset, 19));
  const ParameterEstimate e = last.parameters.at(0);
  EXPECT_EQ(last.state, EstimateState::converged) << "what a tolerated offset leaves is no missing physics";
  EXPECT_GT(e.mean, 1.02 * kTruth);
  EXPECT_TRUE(holds(e, kTruth));
  EXPECT_LT(e.upper95 / e.lower95, 2.2);
}

// No place across the lowest modes tells the noise of a force, so that a wrong damping could pass for it.
TEST(Palpation, AForceThatIsNotExplainedIsNoNoise) {
  const TetMesh mesh = block_mesh();
  const std::vector<Frame> frames = felt(mesh, 0.0, 19);
  const Estimate right = estimate(palpation(prior(60e3, 3), "false"), mesh, frames),
                 wrong =
                     estimate(palpation(prior(60e3, 3), "false", "", "- viscous_damping: {beta: 0.007}\n"), mesh, frames);
  EXPECT_EQ(right.state, EstimateState::converged) << right.state_reason;
  EXPECT_TRUE(holds(right.parameters.at(0), kTruth));
  EXPECT_EQ(wrong.state, EstimateState::doubtful) << wrong.state_reason;
  EXPECT_TRUE(holds(wrong.parameters.at(0), kTruth));
}

// The force grows otherwise with the depth than with the modulus, so both can be found.
TEST(Palpation, TheOffsetCanBeEstimated) {
  const TetMesh mesh = block_mesh();
  ModelSettings settings = palpation(prior(60e3, 3), "false", ", offset: {mean: 0, std: 2.0e-4}");
  settings.exact_inputs = true;
  Estimator estimator(settings, mesh);
  estimator.set_first_stamp(0.0);
  for (const LoadSample& sample : poses()) estimator.add_load(sample);
  estimator.replay(felt(mesh, kOffset, 16));
  const std::vector<ParameterEstimate>& found = estimator.estimate().parameters;
  ASSERT_EQ(found.size(), 2U);
  std::printf("E %.1f of %.1f, offset %.4f of %.4f mm\n", found[0].mean, kTruth, 1e3 * found[1].mean, 1e3 * kOffset);
  EXPECT_NEAR(found[0].mean, kTruth, 0.02 * kTruth);
  EXPECT_NEAR(found[1].mean, kOffset, 0.1 * kOffset);
}

// The truth comes from a mesh with eight times as many tetrahedra, which is softer.
TEST(Palpation, TheMeshsErrorIsThatOfTheContact) {
  const TetMesh mesh = block_mesh(2);
  const std::vector<Frame> frames = felt(block_mesh(4), 0.0, 16);
  const ParameterEstimate blind = estimated(palpation(prior(60e3, 3), "false"), mesh, frames),
                          corrected = estimated(palpation(prior(60e3, 3), "true"), mesh, frames);
  EXPECT_LT(std::abs(corrected.mean / kTruth - 1.0), 0.7 * std::abs(blind.mean / kTruth - 1.0));
  EXPECT_TRUE(holds(corrected, kTruth));
}

}  // namespace
}  // namespace tissue_stiffness
