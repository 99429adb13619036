#include "memory.hpp"

#include <malloc.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>

namespace tissue_stiffness {

void forget_peak_memory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024.0;
  }
  throw std::runtime_error("/proc/self/status tells no VmHWM");
}

double memory_bandwidth() {
  constexpr Eigen::Index count = Eigen::Index{1} << 26, grain = Eigen::Index{1} << 20;
  const Eigen::VectorXd data = Eigen::VectorXd::Ones(count);
  double best = 0.0;
  for (int k = 0; k < 5; ++k) {
    const auto start = std::chrono::steady_clock::now();
    const double sum = tbb::parallel_reduce(
        tbb::blocked_range<Eigen::Index>(0, count, grain), 0.0,
        [&data](const auto& part, double before) {
          return before + data.segment(part.begin(), static_cast<Eigen::Index>(part.size())).sum();
        },
        [](double a, double b) { return a + b; });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (sum != static_cast<double>(count)) throw std::runtime_error("the sum is wrong");
    best = std::max(best, 8e-9 * static_cast<double>(count) / seconds);
  }
  return best;
}

}  // namespace tissue_stiffness
