#include "tissue_stiffness/estimation/settling.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kFewest = 8, kMost = 200;  // frames

}  // namespace

void Settling::add(const Eigen::VectorXd& mean, const Eigen::VectorXd& std) {
  ++frames_;
  means_.push_back(mean);
  std_ = std;
  while (means_.size() > std::clamp(frames_ / 3, kFewest, kMost)) means_.pop_front();
}

bool Settling::settled() const {
  if (means_.size() < kFewest) return false;
  return std::all_of(means_.begin(), means_.end(), [this](const Eigen::VectorXd& mean) {
    return ((mean - means_.back()).array().abs() <= std_.array()).all();
  });
}

}  // namespace tissue_stiffness
