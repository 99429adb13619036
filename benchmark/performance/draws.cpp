#include "draws.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene.hpp"

namespace tissue_stiffness {
namespace {

struct Draw {
  double modulus_off, std, tip_off, basis_error;  // shares of the truth, of the tip's largest motion; [m]
  bool held;
  std::string model;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Draw draw_one(int cells, int across, int frames, unsigned seed) {
  std::mt19937 engine(seed);
  const double truth = kTruth * std::exp(std::uniform_real_distribution<double>(-0.2, 0.2)(engine));
  Scene scene = make_scene(Scene::Law::neo_hookean, cells, across);
  scene.settings.exact_inputs = true;  // so that nothing else widens the interval
  const Eigen::MatrixXd motion = move(scene, frames, truth);
  Estimator estimator(scene.settings, scene.mesh);
  estimator.set_first_stamp(0.0);
  const Eigen::Index tip = scene.mesh.node_count() - 1;
  double off = 0.0, most = 0.0;
  Eigen::Index k = 0;
  for (const Frame& frame : film(scene, frames, truth, seed)) {
    if (const StepResult result = estimator.step(frame); !result.used) throw std::runtime_error(result.reason);
    const Eigen::Vector3d moved = motion.col(k++).segment<3>(3 * tip);
    most = std::max(most, moved.norm());
    if (2 * k > frames) off = std::max(off, (estimator.displacement().col(tip) - moved).norm());  // the estimate is near
  }
  const ParameterEstimate& modulus = estimator.estimate().parameters.front();
  return {modulus.mean / truth - 1.0,
          modulus.std / truth,
          off / most,
          estimator.basis_error().value_or(0.0),
          modulus.lower95 <= truth && truth <= modulus.upper95,
          estimator.description().front()};
}

}  // namespace

void print_draws(int draws, int cells, int across, int frames) {
  std::vector<double> modulus, std, tip, basis;
  int held = 0;
  for (int i = 1; i <= draws; ++i) {
    const Draw one = draw_one(cells, across, frames, static_cast<unsigned>(i));
    modulus.push_back(std::abs(one.modulus_off));
    std.push_back(one.std);
    tip.push_back(one.tip_off);
    basis.push_back(one.basis_error);
    held += one.held ? 1 : 0;
    std::fprintf(stderr, "%d: E off %+.4f %%, std %.4f %%, tip off %.3f %%, basis error %.1f um, %s; %s\n", i,
                 100.0 * one.modulus_off, 100.0 * one.std, 100.0 * one.tip_off, 1e6 * one.basis_error,
                 one.held ? "held" : "missed", one.model.c_str());
  }
  std::printf(
      "| nodes | draws | E off, median | most | stated, median | tip off, median | most | basis error [um] | held |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  std::printf("| %d | %d | %.3f %% | %.3f %% | %.3f %% | %.3f %% | %.3f %% | %.1f | %d of %d |\n",
              (2 * cells + 1) * (2 * across + 1) * (2 * across + 1), draws, 100.0 * median(modulus),
              100.0 * *std::max_element(modulus.begin(), modulus.end()), 100.0 * median(std), 100.0 * median(tip),
              100.0 * *std::max_element(tip.begin(), tip.end()), 1e6 * median(basis), held, draws);
}

}  // namespace tissue_stiffness
