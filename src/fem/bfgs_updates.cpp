#include "fem/bfgs_updates.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

constexpr double kFlat = 1e-8;  // relative curvature below which an update says nothing

}  // namespace

void BfgsUpdates::learn(Eigen::VectorXd& step, Eigen::VectorXd& change) {
  const double curvature = step.dot(change);
  if (!(curvature > kFlat * step.norm() * change.norm())) return;
  newest_ = (newest_ + 1) % kMost;
  count_ = std::min(count_ + 1, kMost);
  Update& u = update(0);
  u.step.swap(step);
  u.change.swap(change);
  u.inverse_curvature = 1.0 / curvature;
}

void BfgsUpdates::before(Eigen::Ref<Eigen::VectorXd> r) {
  for (std::size_t age = 0; age < count_; ++age) {
    Update& u = update(age);
    u.weight = u.inverse_curvature * u.step.dot(r);
    r -= u.weight * u.change;
  }
}

void BfgsUpdates::after(Eigen::VectorXd& direction) const {
  for (std::size_t age = count_; age-- > 0;) {
    const Update& u = update(age);
    direction += (u.weight - u.inverse_curvature * u.change.dot(direction)) * u.step;
  }
}

}  // namespace tissue_stiffness
