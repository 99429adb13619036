// Cost of the estimator by size and law, one frame an iteration. Counters: nodes; start_s, from the model to the first
// estimate; first_ms, median_ms and p99_ms of a frame: the second or third, which a nonlinear model runs in full, and all;
// replay_s, spent on reprocessing earlier frames and on checking the basis; heap_requests and heap_kB of a frame, medians;
// peak_MB; factor_MB of the full model's matrix; error_pct of the estimate at the end.
//
// usage: performance [--export FOLDER CELLS ACROSS FRAMES | --draws DRAWS CELLS ACROSS FRAMES] [Google Benchmark's flags]
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>

#include "draws.hpp"
#include "export.hpp"
#include "fem/sparse_solver.hpp"
#include "heap/heap.hpp"
#include "memory.hpp"
#include "scene.hpp"

namespace {

using namespace tissue_stiffness;
using Clock = std::chrono::steady_clock;

struct Size {
  int cells, across;
  int frames[2];  ///< linear, neo-Hookean
};
// 1,029, 5,577, 20,727 and 50,301 nodes.
constexpr Size kSizes[] = {{10, 3, {600, 120}}, {16, 6, {600, 60}}, {23, 10, {300, 16}}, {34, 13, {300, 8}}};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

double factor_megabytes(const Scene& scene) {
  const Model model(scene.settings, scene.mesh);
  const Eigen::VectorXd theta = model.parameters().theta(model.parameters().prior_mean());
  SparseMatrix k = model.reference_stiffness(theta);
  fix_dofs(k, model.fixed(), k.diagonal().mean());
  SparseSolver solver;
  solver.factorize(k);
  return 8e-6 * solver.factor_size();
}

void run(benchmark::State& state, Scene::Law law, const Size& size) {
  const Scene scene = make_scene(law, size.cells, size.across);
  const std::vector<Frame> frames = film(scene, static_cast<int>(state.max_iterations) + 1);
  const double factor = factor_megabytes(scene);
  forget_peak_memory();
  const Clock::time_point start = Clock::now();
  Estimator estimator(scene.settings, scene.mesh);
  estimator.set_first_stamp(0.0);
  estimator.step(frames.front());
  state.counters["start_s"] = seconds_since(start);
  std::vector<double> times, requests, kilobytes;
  double reprocess = 0.0;
  for (auto unused : state) {
    benchmark::DoNotOptimize(unused);
    const Clock::time_point before = Clock::now();
    const Heap asked = heap();
    const StepResult result = estimator.step(frames[times.size() + 1]);
    if (!result.used) return state.SkipWithError(result.reason.c_str());
    const double all = seconds_since(before), again = result.seconds.at("reprocess");
    requests.push_back(static_cast<double>(heap().requests - asked.requests));
    kilobytes.push_back(1e-3 * static_cast<double>(heap().bytes - asked.bytes));
    times.push_back(all - again);
    reprocess += again;
    state.SetIterationTime(all);
  }
  state.counters["nodes"] = scene.mesh.node_count();
  state.counters["median_ms"] = 1e3 * quantile(times, 0.5);
  state.counters["first_ms"] =
      1e3 *
      quantile({times.begin(), times.begin() + std::min<std::ptrdiff_t>(2, static_cast<std::ptrdiff_t>(times.size()))},
               0.5);
  state.counters["p99_ms"] = 1e3 * quantile(times, 0.99);
  state.counters["replay_s"] = reprocess;
  state.counters["heap_requests"] = quantile(requests, 0.5);
  state.counters["heap_kB"] = quantile(kilobytes, 0.5);
  state.counters["peak_MB"] = peak_memory();
  state.counters["factor_MB"] = factor;
  state.counters["basis_um"] = 1e6 * estimator.basis_error().value_or(0.0);
  const ParameterEstimate& modulus = estimator.estimate().parameters.front();
  state.counters["error_pct"] = 100.0 * (std::sqrt(modulus.lower95 * modulus.upper95) / kTruth - 1.0);  // of the median
}

void bandwidth(benchmark::State& state) {
  for (auto unused : state) {
    benchmark::DoNotOptimize(unused);
    state.counters["GB_per_s"] = memory_bandwidth();
  }
}

void register_all() {
  benchmark::RegisterBenchmark("bandwidth", bandwidth)->Iterations(1);
  for (const Scene::Law law : {Scene::Law::linear, Scene::Law::neo_hookean}) {
    const bool linear = law == Scene::Law::linear;
    for (const Size& size : kSizes) {
      const std::string name = std::string(linear ? "linear" : "neo_hookean") + "/" +
                               std::to_string((2 * size.cells + 1) * (2 * size.across + 1) * (2 * size.across + 1));
      benchmark::RegisterBenchmark(name.c_str(), [law, size](benchmark::State& state) { run(state, law, size); })
          ->Iterations(size.frames[linear ? 0 : 1])
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 6 && std::strcmp(argv[1], "--export") == 0) {
      const Scene scene = make_scene(Scene::Law::linear, std::stoi(argv[3]), std::stoi(argv[4]));
      export_problem(scene, std::stoi(argv[5]), argv[2]);
      return 0;
    }
    if (argc == 6 && std::strcmp(argv[1], "--draws") == 0) {
      print_draws(std::stoi(argv[2]), std::stoi(argv[3]), std::stoi(argv[4]), std::stoi(argv[5]));
      return 0;
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    register_all();
    benchmark::RunSpecifiedBenchmarks();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "performance: %s\n", error.what());
    return 1;
  }
}
