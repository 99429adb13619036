#include "estimation/validity.hpp"

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr int kMemory = 30;            // frames that the means remember
constexpr int kFewest = 8;             // frames before which nothing is said
constexpr double kNoise = 4.0;         // mean square of error over sigma: a model that fits has 1
constexpr double kUnexplained = 0.04;  // of the motion's mean square: 20 % of its amplitude

}  // namespace

void Validity::add(const Misfit& misfit) {
  if (misfit.count == 0) return;
  const double weight = 1.0 / std::min(++frames_, kMemory);
  sigmas_ += weight * (std::pow(misfit.rms_sigma, 2) - sigmas_);
  error_ += weight * (std::pow(misfit.rms, 2) - error_);
  motion_ += weight * (std::pow(misfit.motion_rms, 2) - motion_);
}

bool Validity::invalid() const {
  return frames_ >= kFewest && sigmas_ > kNoise && error_ > kUnexplained * motion_;
}

}  // namespace tissue_stiffness
