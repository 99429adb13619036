// Calibration: a bar released under gravity and filmed; noise and starting point drawn anew for every seed, the starting
// point log-normal about the truth with the prior's own factor, as Bayes' theorem presumes.
#include <cmath>
#include <string>

#include "experiment.hpp"
#include "figures.hpp"
#include "filter/consistency.hpp"
#include "meshing/box_mesh.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 30e3, kFactor = 3.0, kNoise = 5e-4;
constexpr int kFrames = 25, kSeeds = 100;
constexpr double kInterval = 0.02;

// What the estimator said about one simulated recording.
struct Trial {
  double off;  ///< (estimate - truth) / posterior standard deviation, of log E
  bool covered;
  double nis;  ///< summed over the frames
  int dof;
};

ModelSettings settings(double prior) {
  const std::string text =
      "mesh: {file: bar.vtk, discretisation_error: false}\n"
      "regions: {clamp: {box: {min: [-1, -1, -1], max: [1.0e-6, 1, 1]}}}\n"
      "effects:\n"
      "- inertia: {density: 1000}\n"
      "- elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: {prior: " +
      std::to_string(prior) + ", factor: " + std::to_string(kFactor) +
      "}}\n"
      "- fixed: {region: clamp}\n"
      "- gravity: {acceleration: [0, 1, -3]}\n"
      "observations: [{vertices: {topic: /vertices, noise: " +
      std::to_string(kNoise) + "}}]\ninputs: exact\n";
  return read_model(parse_yaml(text, "bar"), "");
}

Trial run(const TetMesh& mesh, const std::vector<Experiment::Moment>& moments, const Experiment& truth, unsigned seed) {
  std::mt19937 engine(1000 + seed);
  const double start = std::exp(std::log(kFactor) * std::normal_distribution<double>()(engine));
  Estimator estimator(settings(kTruth * start), mesh);
  Trial trial{0.0, false, 0.0, 0};
  for (const Frame& frame : see_all(truth, moments, kNoise, seed)) {
    const StepResult step = estimator.step(frame);
    trial.nis += step.misfit.nis;
    trial.dof += step.misfit.dof;
  }
  const ParameterEstimate& modulus = estimator.estimate().parameters.front();
  trial.covered = modulus.lower95 <= kTruth && kTruth <= modulus.upper95;
  const double variance = std::log1p(std::pow(modulus.std / modulus.mean, 2));
  trial.off = (std::log(modulus.mean / kTruth) - 0.5 * variance) / std::sqrt(variance);
  return trial;
}

}  // namespace

std::vector<Figure> coverage_figures() {
  const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, 2);
  const Experiment truth(settings(kTruth), mesh, {kTruth});
  const auto moments = truth.film(0.0, kInterval, kFrames);
  ConsistencySum innovations, errors;
  int covered = 0, surprising = 0;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const Trial trial = run(mesh, moments, truth, seed);
    covered += trial.covered ? 1 : 0;
    innovations.add(trial.nis, trial.dof);
    errors.add(trial.off * trial.off, 1);
    surprising += two_sided_p_value(trial.nis, trial.dof) < 0.05 ? 1 : 0;
  }
  const double rows = innovations.dof;
  return {{"seeds of 100 whose 95 % interval holds the truth", static_cast<double>(covered), 90.0, 98.0},
          {"mean of (error / posterior std)^2 over the seeds", errors.mean_per_dof(),
           chi_squared_quantile(0.0005, kSeeds) / kSeeds, chi_squared_quantile(0.9995, kSeeds) / kSeeds},
          {"NIS a row over the seeds", innovations.mean_per_dof(), chi_squared_quantile(0.0005, rows) / rows,
           chi_squared_quantile(0.9995, rows) / rows},
          // 5 expected; more than 12 once in a thousand times.
          {"seeds of 100 whose NIS is beyond its own 95 % bounds", static_cast<double>(surprising), 0.0, 12.0}};
}

}  // namespace tissue_stiffness
