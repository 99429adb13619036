#include "coverage.hpp"

#include <cmath>
#include <string>

#include "experiment.hpp"
#include "tissue_stiffness/meshing/box_mesh.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 30e3, kFactor = 3.0, kNoise = 5e-4;
constexpr int kFrames = 25;
constexpr double kInterval = 0.02;

ModelSettings settings(double prior) {
  const std::string text =
      "mesh: {file: bar.vtk}\n"
      "regions: {clamp: {box: {min: [-1, -1, -1], max: [1.0e-6, 1, 1]}}}\n"
      "effects:\n"
      "- inertia: {density: 1000}\n"
      "- elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: {prior: " +
      std::to_string(prior) + ", factor: " + std::to_string(kFactor) +
      "}}\n"
      "- fixed: {region: clamp}\n"
      "- gravity: {acceleration: [0, 1, -3]}\n"
      "observations: [{vertices: {topic: /vertices, noise: " +
      std::to_string(kNoise) + "}}]\n";
  return read_model(parse_yaml(text, "bar"), "");
}

Trial run(const TetMesh& mesh, const std::vector<Experiment::Moment>& moments, const Experiment& truth, unsigned seed) {
  std::mt19937 engine(1000 + seed);
  const double start = std::exp(std::log(kFactor) * std::normal_distribution<double>()(engine));
  Estimator estimator(settings(kTruth * start), mesh);
  Trial trial{start, 0.0, 0.0, false, 0.0, 0.0};
  for (const Frame& frame : see_all(truth, moments, kNoise, seed)) {
    const StepResult step = estimator.step(frame);
    trial.nis += step.misfit.nis;
    trial.dof += step.misfit.dof;
  }
  const ParameterEstimate& modulus = estimator.estimate().parameters.front();
  trial.covered = modulus.lower95 <= kTruth && kTruth <= modulus.upper95;
  trial.relative = std::sqrt(std::log1p(std::pow(modulus.std / modulus.mean, 2)));
  const double log_median = std::log(modulus.mean) - 0.5 * trial.relative * trial.relative;
  trial.off = (log_median - std::log(kTruth)) / trial.relative;
  return trial;
}

}  // namespace

std::vector<Trial> calibrate(int seeds) {
  const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, 2);
  const Experiment truth(settings(kTruth), mesh, {kTruth});
  const auto moments = truth.film(0.0, kInterval, kFrames);
  std::vector<Trial> trials;
  for (int seed = 0; seed < seeds; ++seed) trials.push_back(run(mesh, moments, truth, static_cast<unsigned>(seed)));
  return trials;
}

}  // namespace tissue_stiffness
