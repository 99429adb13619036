// Whether intervals hold the truth: scenes drawn anew for every seed, filmed on a finer mesh with a finer step than the
// estimator's, with noise. Prints the table of doc/calibration.md.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "tissue_stiffness/filter/consistency.hpp"
#include "tissue_stiffness/meshing/box_mesh.hpp"
#include "verification/experiment.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFactor = 3.0;  // of the prior: 68 %
constexpr int kFrames = 60;
constexpr int kWithin = 30;  // frames after which an estimate from far off has to be close

/// A body, its effects with two numbers to fill in, and how both are drawn.
struct Scene {
  std::string name;
  Eigen::Vector3d size;  ///< [m]
  Eigen::Vector3i cells, fine;
  std::string effects;     ///< with %g for Young's modulus's entry and the load's three components
  double low, high;        ///< of the truth [Pa]
  Eigen::Vector3d load;    ///< typical
  double noise, interval;  ///< [m], [s]
};

const std::vector<Scene>& scenes() {
  static const std::string gravity = "gravity: {acceleration: [%g, %g, %g]}";
  // clang-format off
  static const std::vector<Scene> all{
      {"bar released under gravity", {0.10, 0.02, 0.02}, {8, 2, 2}, {24, 6, 6}, gravity,
       10e3, 100e3, {0.5, 1.0, -3.0}, 3e-4, 0.02},
      {"block pushed on its top", {0.06, 0.06, 0.04}, {4, 4, 2}, {12, 12, 6}, "traction: {region: top, topic: /force}",
       3e3, 30e3, {0.2, 0.1, -0.5}, 2e-4, 0.02},
      {"slab pressed on a quarter", {0.08, 0.06, 0.02}, {4, 4, 2}, {12, 12, 6}, "traction: {region: patch, topic: /force}",
       5e3, 50e3, {0.04, -0.04, -0.3}, 1e-4, 0.005}};
  // clang-format on
  return all;
}

std::string filled(const std::string& pattern, const Eigen::Vector3d& v) {
  char text[200];
  std::snprintf(text, sizeof text, pattern.c_str(), v.x(), v.y(), v.z());
  return text;
}

ModelSettings settings(const Scene& scene, double prior, const Eigen::Vector3d& load, bool mesh_error = false) {
  const Eigen::Vector3d& s = scene.size;
  char text[1200];
  std::snprintf(text, sizeof text,
                "mesh: {file: body.vtk, discretisation_error: %s}\n"
                "regions:\n"
                "  foot: {box: {min: [-1, -1, -1], max: %s}}\n"
                "  top: {box: {min: [-1, -1, %.9g], max: [1, 1, 1]}}\n"
                "  patch: {box: {min: [%.9g, %.9g, %.9g], max: [1, 1, 1]}}\n"
                "effects:\n"
                "- inertia: {density: 1000}\n"
                "- elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: {prior: %.9g, factor: %g}}\n"
                "- fixed: {region: foot}\n"
                "- mass_damping: {alpha: 2}\n"
                "- %s\n"
                "observations: [{vertices: {topic: /vertices, noise: %g}}]\n",
                mesh_error ? "true" : "false", s.x() > 2.0 * s.z() && s.y() < 0.03 ? "[1.0e-6, 1, 1]" : "[1, 1, 1.0e-6]",
                s.z() - 1e-6, 0.5 * s.x() - 1e-6, 0.5 * s.y() - 1e-6, s.z() - 1e-6, prior, kFactor,
                filled(scene.effects, load).c_str(), scene.noise);
  return read_model(parse_yaml(text, "calibration"), "");
}

// So large that what it leaves out is far below the noise of a whole recording.
BasisOptions whole() {
  BasisOptions options;
  options.size = options.largest = 160;
  return options;
}

std::vector<int> surface_vertices(const TetMesh& mesh) {
  std::vector<int> ids;
  const Eigen::Vector3d low = mesh.nodes.rowwise().minCoeff(), high = mesh.nodes.rowwise().maxCoeff();
  for (int i = 0; i < mesh.corner_count; ++i) {
    const Eigen::Vector3d x = mesh.nodes.col(i);
    if (((x - low).cwiseMin(high - x).array() < 1e-9).any()) ids.push_back(i);
  }
  return ids;
}

struct Trial {
  double error = 0.0;  ///< relative
  double early = 0.0;  ///< the same after kWithin frames, from ten times off
  double off = 0.0;    ///< log E's error over its standard deviation
  double width = 0.0;  ///< of the interval, half, relative
  bool covered = false;
};

double modulus_after(Estimator& estimator, const std::vector<Frame>& frames, int count) {
  for (int k = 0; k < count; ++k) estimator.step(frames[static_cast<std::size_t>(k)]);
  return estimator.estimate().parameters.front().mean;
}

// `filmed`: the mesh that the recording comes from.
Trial run(const Scene& scene, const TetMesh& mesh, const TetMesh& filmed, bool mesh_error, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  const double modulus = scene.low * std::pow(scene.high / scene.low, uniform(engine));
  Eigen::Vector3d load = scene.load;
  for (double& component : load) component *= 0.5 + uniform(engine);
  load *= modulus / std::sqrt(scene.low * scene.high);  // about the same motion
  Experiment truth(settings(scene, modulus, load), filmed, {modulus}, whole());
  const bool pressed = scene.effects.find("/force") != std::string::npos;
  Eigen::VectorXd wrench = Eigen::VectorXd::Zero(6);
  wrench.head(3) = load;
  if (pressed) truth.add_load({"/force", 0.0, wrench});
  const std::vector<Frame> frames =
      see_on(mesh, surface_vertices(mesh), truth, truth.film(0.0, scene.interval, kFrames), scene.noise, engine);
  // The prior means what it says: the truth is drawn from it.
  Estimator estimator(settings(scene, modulus * std::exp(std::log(kFactor) * normal(engine)), load, mesh_error), mesh);
  if (pressed) estimator.add_load({"/force", 0.0, wrench});
  modulus_after(estimator, frames, kFrames);
  const ParameterEstimate& e = estimator.estimate().parameters.front();
  Estimator from_far(settings(scene, uniform(engine) < 0.5 ? 10.0 * modulus : 0.1 * modulus, load, mesh_error), mesh);
  if (pressed) from_far.add_load({"/force", 0.0, wrench});
  Trial out;
  out.error = e.mean / modulus - 1.0;
  out.covered = e.lower95 <= modulus && modulus <= e.upper95;
  const double variance = std::log1p(std::pow(e.std / e.mean, 2));
  out.off = (std::log(e.mean / modulus) - 0.5 * variance) / std::sqrt(variance);
  out.width = 0.5 * (e.upper95 - e.lower95) / modulus;
  out.early = modulus_after(from_far, frames, kWithin) / modulus - 1.0;
  return out;
}

void print(const std::string& name, const std::vector<Trial>& trials) {
  double covered = 0.0, error = 0.0, bias = 0.0, worst = 0.0, square = 0.0, width = 0.0, early = 0.0;
  for (const Trial& t : trials) {
    covered += t.covered ? 1.0 : 0.0;
    error += std::abs(t.error);
    bias += t.error;
    worst = std::max(worst, std::abs(t.error));
    square += t.off * t.off;
    width += t.width;
    early += std::abs(t.early) < 0.05 ? 1.0 : 0.0;
  }
  const double n = static_cast<double>(trials.size());
  std::printf("| %s | %.1f %% | %.2f | %.3f %% | %+.3f %% | %.2f %% | %.3f %% | %.1f %% |\n", name.c_str(),
              100.0 * covered / n, square / n, 100.0 * error / n, 100.0 * bias / n, 100.0 * worst, 100.0 * width / n,
              100.0 * early / n);
  std::fflush(stdout);
}

}  // namespace
}  // namespace tissue_stiffness

int main(int argc, char** argv) {
  using namespace tissue_stiffness;
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 200, finer_seeds = argc > 2 ? std::atoi(argv[2]) : seeds;
  std::printf(
      "%d seeds a scene, %d where it is filmed on a finer mesh. %% of seeds whose 95 %% interval holds the truth; mean of "
      "(error over standard deviation)^2; "
      "errors of E; half width of the interval; %% within 5 %% after %d frames from ten times off.\n\n",
      seeds, finer_seeds, kWithin);
  std::printf(
      "| scene | 95 %% holds | NEES | mean error | bias | worst | half width | within 5 %% "
      "|\n|---|---|---|---|---|---|---|---|\n");
  const std::string wanted = argc > 3 ? argv[3] : "";
  for (const Scene& scene : scenes()) {
    if (scene.name.find(wanted) == std::string::npos) continue;
    const Eigen::Vector3i &c = scene.cells, &f = scene.fine;
    const TetMesh mesh = make_box_mesh(scene.size, c.x(), c.y(), c.z(), 2);
    const TetMesh fine = make_box_mesh(scene.size, f.x(), f.y(), f.z(), 2);
    const auto row = [&](const std::string& filmed_on, const TetMesh& filmed, bool mesh_error, int count) {
      std::vector<Trial> trials(static_cast<std::size_t>(count));
      tbb::parallel_for(std::size_t{0}, trials.size(),
                        [&](std::size_t i) { trials[i] = run(scene, mesh, filmed, mesh_error, static_cast<unsigned>(i)); });
      print(scene.name + ", " + filmed_on, trials);
    };
    row("its own mesh", mesh, false, seeds);
    row("a finer mesh", fine, true, finer_seeds);
  }
}
