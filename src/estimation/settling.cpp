#include "estimation/settling.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kFewest = 8, kMost = 200;  // frames
constexpr double kInterval = 1.96;               // standard deviations

}  // namespace

void Settling::add(const Eigen::VectorXd& mean, const Eigen::VectorXd& std) {
  ++frames_;
  published_.push_back({mean, std});
  while (published_.size() > std::clamp(frames_ / 3, kFewest, kMost)) published_.pop_front();
}

bool Settling::settled() const {
  if (published_.size() < kFewest) return false;
  const Eigen::VectorXd& now = published_.back().mean;
  return std::all_of(published_.begin(), published_.end(), [&](const Published& then) {
    return ((then.mean - now).array().abs() <= kInterval * then.std.array()).all();
  });
}

}  // namespace tissue_stiffness
