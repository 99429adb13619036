// Whether intervals hold the truth: scenes drawn anew for every seed, filmed on a finer mesh with a finer step than the
// estimator's, with noise. Prints the table of doc/calibration.md.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "filter/consistency.hpp"
#include "meshing/box_mesh.hpp"
#include "observation/observation_operator.hpp"
#include "verification/experiment.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFactor = 3.0;  // of the prior: 68 %
constexpr int kFrames = 60;
constexpr double kLoadStep = 0.005;  // s
const std::string kTopic = "/force";
constexpr int kWithin = 30;  // frames after which an estimate from far off has to be close

/// A body, its load, and what is seen of it.
struct Scene {
  std::string name;
  Eigen::Vector3d size;  ///< [m]
  Eigen::Vector3i cells, fine;
  std::string face;        ///< that the force acts on
  double low, high;        ///< of the truth [Pa]
  Eigen::Vector3d force;   ///< typical [N]
  double frequency;        ///< of a load that rises and falls again and again [Hz]; 0: one that is there from the start
  int seen;                ///< markers, spread over the surface; 0: one at each of its vertices
  double noise, interval;  ///< [m], [s]
};

// In the first three the noise decides how well E is known, in the last three the mesh does.
const std::vector<Scene>& scenes() {
  // clang-format off
  static const std::vector<Scene> all{
      {"bar bent", {0.10, 0.02, 0.02}, {22, 3, 3}, {35, 7, 7}, "tip",
       10e3, 100e3, {0.0013, 0.002, -0.004}, 1.0, 8, 4e-4, 1.0 / 30},
      {"column pushed", {0.03, 0.03, 0.12}, {5, 5, 16}, {7, 7, 24}, "top",
       3e3, 30e3, {0.004, 0.003, -0.02}, 1.0, 8, 5.2e-4, 1.0 / 30},
      {"strip pushed at its end", {0.12, 0.03, 0.012}, {22, 6, 2}, {32, 9, 4}, "tip",
       10e3, 100e3, {0.001, 0.003, -0.0012}, 0.8, 8, 5e-4, 1.0 / 30},
      {"bar loaded at its tip at once", {0.10, 0.02, 0.02}, {8, 2, 2}, {24, 6, 6}, "tip",
       10e3, 100e3, {0.002, 0.006, -0.01}, 0.0, 0, 3e-4, 0.02},
      {"block pushed on its top", {0.06, 0.06, 0.04}, {4, 4, 2}, {12, 12, 6}, "top",
       3e3, 30e3, {0.2, 0.1, -0.5}, 0.0, 0, 2e-4, 0.02},
      {"slab pressed on a quarter", {0.08, 0.06, 0.02}, {4, 4, 2}, {12, 12, 6}, "patch",
       5e3, 50e3, {0.04, -0.04, -0.3}, 0.0, 0, 1e-4, 0.005}};
  // clang-format on
  return all;
}

std::string format(const char* pattern, const Eigen::Vector3d& v) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, v.x(), v.y(), v.z());
  return text;
}

Eigen::Matrix3Xd markers(const Scene& scene, const TetMesh& mesh) {
  std::vector<int> surface;
  for (int i = 0; i < mesh.corner_count; ++i) {
    const Eigen::Vector3d x = mesh.nodes.col(i);
    if ((x.cwiseMin(scene.size - x).array() < 1e-9).any()) surface.push_back(i);
  }
  const std::size_t count = scene.seen == 0 ? surface.size() : static_cast<std::size_t>(scene.seen);
  Eigen::Matrix3Xd rest(3, count);
  for (std::size_t k = 0; k < count; ++k) {
    rest.col(static_cast<Eigen::Index>(k)) = mesh.nodes.col(surface[(2 * k + 1) * surface.size() / (2 * count)]);
  }
  return rest;
}

struct Prior {
  double modulus;  ///< [Pa]
  bool mesh_error;
};

ModelSettings settings(const Scene& scene, const Eigen::Matrix3Xd& rest, const Prior& prior) {
  const Eigen::Vector3d& s = scene.size;
  const bool lies = scene.face == "tip";
  std::ostringstream text;
  text << "mesh: {file: body.vtk, discretisation_error: " << (prior.mesh_error ? "true" : "false") << "}\n"
       << "regions:\n"
       << "  foot: {box: {min: [-1, -1, -1], max: " << (lies ? "[1.0e-6, 1, 1]" : "[1, 1, 1.0e-6]") << "}}\n"
       << format("  tip: {box: {min: [%.9g, -1, -1], max: [1, 1, 1]}}\n", {s.x() - 1e-6, 0, 0})
       << format("  top: {box: {min: [-1, -1, %.9g], max: [1, 1, 1]}}\n", {s.z() - 1e-6, 0, 0})
       << format("  patch: {box: {min: [%.9g, %.9g, %.9g], max: [1, 1, 1]}}\n",
                 s.cwiseProduct(Eigen::Vector3d(0.5, 0.5, 1.0)) - Eigen::Vector3d::Constant(1e-6))
       << "effects:\n- inertia: {density: 1000}\n"
       << "- elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: {prior: " << prior.modulus
       << ", factor: " << kFactor
       << "}}\n- fixed: {region: foot}\n- mass_damping: {alpha: 2}\n- traction: {region: " << scene.face
       << ", topic: /force}\n"
       << "observations: [{markers: {topic: /markers, noise: " << scene.noise << ", rest: [";
  for (Eigen::Index i = 0; i < rest.cols(); ++i) text << format("[%.9g, %.9g, %.9g],", rest.col(i));
  text << "]}}]\n";
  return read_model(parse_yaml(text.str(), "calibration"), "");
}

// So large that what it leaves out is far below the noise of a whole recording.
BasisOptions whole() {
  BasisOptions options;
  options.size = options.largest = 160;
  return options;
}

struct Trial {
  double error = 0.0;  ///< relative
  double early = 0.0;  ///< the same after kWithin frames, from ten times off
  double off = 0.0;    ///< log E's error over its standard deviation
  double width = 0.0;  ///< of the interval, half, relative
  bool covered = false;
};

/// The body that is filmed, on a mesh of its own.
class Studio {
 public:
  Studio(const Scene& scene, const TetMesh& mesh, const Eigen::Matrix3Xd& rest)
      : scene_(scene),
        body_(settings(scene, rest, {scene.low, false}), mesh, {scene.low}, whole()),
        operators_(make_observation_operators(body_.model())) {
    seen_.kind = ObservationKind::markers;
    seen_.ids = Eigen::VectorXi::LinSpaced(rest.cols(), 0, static_cast<int>(rest.cols()) - 1);
    seen_.points.setZero(3, rest.cols());
  }

  // One recording at a time: its loads are the body's own.
  std::vector<Frame> film(double modulus, const std::vector<LoadSample>& loads, std::mt19937& engine) {
    const std::lock_guard<std::mutex> lock(mutex_);
    body_.set_truth({modulus});
    body_.clear_loads();
    for (const LoadSample& load : loads) body_.add_load(load);
    std::vector<Frame> frames;
    for (const Experiment::Moment& moment : body_.film(0.0, scene_.interval, kFrames)) {
      Observation seen = seen_;
      seen.time = moment.time;
      seen.points = draw(seen.points.cols(), scene_.noise, engine);
      const Eigen::VectorXd predicted = operators_.front()->predict(seen_, moment.displacement).predicted;
      seen.points += Eigen::Map<const Eigen::Matrix3Xd>(predicted.data(), 3, seen.points.cols());
      frames.push_back({moment.time, {seen}});
    }
    return frames;
  }

 private:
  const Scene& scene_;
  Experiment body_;
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
  Observation seen_;
  std::mutex mutex_;
};

std::vector<LoadSample> course(const Scene& scene, const Eigen::Vector3d& force) {
  Eigen::VectorXd wrench = Eigen::VectorXd::Zero(6);
  wrench.head<3>() = force;
  if (scene.frequency == 0.0) return {{kTopic, 0.0, wrench}};
  std::vector<LoadSample> samples;
  for (double t = 0.0; t < kFrames * scene.interval; t += kLoadStep) {
    samples.push_back({kTopic, t, 0.5 * (1.0 - std::cos(2.0 * M_PI * scene.frequency * t)) * wrench});
  }
  return samples;
}

double modulus_after(Estimator& estimator, const std::vector<LoadSample>& loads, const std::vector<Frame>& frames,
                     int count) {
  for (const LoadSample& load : loads) estimator.add_load(load);
  for (int k = 0; k < count; ++k) estimator.step(frames[static_cast<std::size_t>(k)]);
  return estimator.estimate().parameters.front().mean;
}

Trial run(const Scene& scene, const TetMesh& mesh, const Eigen::Matrix3Xd& rest, Studio& studio, bool mesh_error,
          unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  const double modulus = scene.low * std::pow(scene.high / scene.low, uniform(engine));
  Eigen::Vector3d force = scene.force;
  for (double& component : force) component *= 0.75 + 0.5 * uniform(engine);
  force *= modulus / std::sqrt(scene.low * scene.high);  // about the same motion
  const std::vector<LoadSample> loads = course(scene, force);
  const std::vector<Frame> frames = studio.film(modulus, loads, engine);
  // The prior means what it says: the truth is drawn from it.
  Estimator estimator(settings(scene, rest, {modulus * std::exp(std::log(kFactor) * normal(engine)), mesh_error}), mesh);
  modulus_after(estimator, loads, frames, kFrames);
  const ParameterEstimate& e = estimator.estimate().parameters.front();
  Estimator from_far(settings(scene, rest, {uniform(engine) < 0.5 ? 10.0 * modulus : 0.1 * modulus, false}), mesh);
  Trial out;
  out.error = e.mean / modulus - 1.0;
  out.covered = e.lower95 <= modulus && modulus <= e.upper95;
  const double variance = std::log1p(std::pow(e.std / e.mean, 2));
  out.off = (std::log(e.mean / modulus) - 0.5 * variance) / std::sqrt(variance);
  out.width = 0.5 * (e.upper95 - e.lower95) / modulus;
  out.early = modulus_after(from_far, loads, frames, kWithin) / modulus - 1.0;
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
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 200, few = argc > 2 ? std::atoi(argv[2]) : seeds;
  std::printf(
      "%d seeds a scene, %d where the mesh decides. %% of seeds whose 95 %% interval holds the truth; mean of "
      "(error over standard deviation)^2; "
      "errors of E; half width of the interval; %% within 5 %% after %d frames from ten times off.\n\n",
      seeds, few, kWithin);
  std::printf(
      "| scene | 95 %% holds | NEES | mean error | bias | worst | half width | within 5 %% "
      "|\n|---|---|---|---|---|---|---|---|\n");
  const std::string wanted = argc > 3 ? argv[3] : "";
  for (const Scene& scene : scenes()) {
    if (scene.name.find(wanted) == std::string::npos) continue;
    const Eigen::Vector3i &c = scene.cells, &f = scene.fine;
    const TetMesh mesh = make_box_mesh(scene.size, c.x(), c.y(), c.z(), 2);
    const TetMesh fine = make_box_mesh(scene.size, f.x(), f.y(), f.z(), 2);
    const Eigen::Matrix3Xd rest = markers(scene, mesh);
    const auto row = [&](const std::string& filmed_on, const TetMesh& filmed, bool mesh_error, int count) {
      Studio studio(scene, filmed, rest);
      std::vector<Trial> trials(static_cast<std::size_t>(count));
      tbb::parallel_for(std::size_t{0}, trials.size(), [&](std::size_t i) {
        trials[i] = run(scene, mesh, rest, studio, mesh_error, static_cast<unsigned>(i));
      });
      print(scene.name + ", " + filmed_on, trials);
    };
    const bool mesh_decides = scene.seen == 0;
    if (mesh_decides) row("its own mesh", mesh, false, seeds);
    row("a finer mesh", fine, true, mesh_decides ? few : seeds);
  }
}
