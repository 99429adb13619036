#include "forward/modal_step.hpp"

#include <cmath>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSameStep = 1e-11;   // [s]
constexpr double kLeastAngle2 = 0.1;  // (omega h)^2 below which the closed form would lose digits
constexpr double kMostDamping = 0.9;  // damping ratio, squared: near one it would, too

constexpr int kMostBranches = 6;
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostBranches + 4, kMostBranches + 4>;

template <int size>
Small exponential_of(const Small& a) {
  const Eigen::Matrix<double, size, size> fixed = a;
  return Small(fixed.exp());
}

// With a known size the exponential is several times faster. Sizes 4 and 5 are those without a branch and with one.
Small exponential(const Small& a) {
  if (a.rows() == 4) return exponential_of<4>(a);
  return a.rows() == 5 ? exponential_of<5>(a) : Small(a.exp());
}

// Augmented exponential of a step h of q'' + d q' + w q = f without branches. The rows are q, q', the columns q, q', f and
// its increment.
using Oscillation = Eigen::Matrix<double, 2, 4>;

// The closed form is Clough & Penzien 1993, eq. (2-49), and its integrals over the step.
bool oscillates(double w, double d, double h) {
  return w * h * h > kLeastAngle2 && d * d < 4.0 * kMostDamping * w;
}
Oscillation oscillation(double w, double d, double h) {
  const double omega = std::sqrt(w - 0.25 * d * d), fading = std::exp(-0.5 * d * h);
  const double s = fading * std::sin(omega * h) / omega, c = fading * std::cos(omega * h);
  const double y = c + 0.5 * d * s;             // q after a unit q
  const double once = (1.0 - y) / w;            // q after a unit force
  const double twice = (h - s - d * once) / w;  // and after one that grows as the time
  Oscillation e;
  e << y, s, once, twice / h, -w * s, c - 0.5 * d * s, s, once / h;
  return e;
}

}  // namespace

ModalStep::ModalStep(Eigen::VectorXd square, Eigen::VectorXd damping, std::vector<Relaxation> branches)
    : square_(std::move(square)), damping_(std::move(damping)), branches_(std::move(branches)) {
  if (branches_.size() > kMostBranches) {
    throw InputError("viscoelasticity", std::to_string(branches_.size()) + " branches",
                     "at most " + std::to_string(kMostBranches));
  }
}

void ModalStep::prepare(double step) {
  if (std::abs(step - step_) < kSameStep) return;
  step_ = step;
  const Eigen::Index n = states(), f = n;  // columns f, f + 1: the force and its increment over the step
  transition_.assign(static_cast<std::size_t>(n * (n + 2)), Eigen::ArrayXd(square_.size()));
  const auto keep = [&](const auto& e, Eigen::Index mode) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n + 2; ++j) entry(i, j)[mode] = j == f ? e(i, f) - e(i, f + 1) : e(i, j);
    }
  };
  Small a(n + 2, n + 2);
  for (Eigen::Index mode = 0; mode < square_.size(); ++mode) {
    if (branches_.empty() && oscillates(square_[mode], damping_[mode], step)) {
      keep(oscillation(square_[mode], damping_[mode], step), mode);
      continue;
    }
    a.setZero();
    a(0, 1) = step;
    a(1, 0) = -square_[mode] * step;
    a(1, 1) = -damping_[mode] * step;
    a(1, f) = step;
    a(f, f + 1) = 1.0;
    for (Eigen::Index i = 0; i < n - 2; ++i) {
      const Relaxation& branch = branches_[static_cast<std::size_t>(i)];
      const double pull = branch.modulus * square_[mode] * step, rate = step / branch.time_constant;
      a(1, 0) -= pull;
      a(1, 2 + i) = pull;
      a(2 + i, 0) = rate;
      a(2 + i, 2 + i) = -rate;
    }
    keep(exponential(a), mode);
  }
}

void ModalStep::advance(double step, const Eigen::VectorXd& before, const Eigen::VectorXd& after, Eigen::MatrixXd& state) {
  prepare(step);
  const Eigen::Index n = states();
  Eigen::ArrayXXd next(state.rows(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    next.col(i) = entry(i, n) * before.array() + entry(i, n + 1) * after.array();
    for (Eigen::Index j = 0; j < n; ++j) next.col(i) += entry(i, j) * state.col(j).array();
  }
  state = next;
}

Eigen::VectorXd ModalStep::stretch(const Eigen::MatrixXd& state, double stiffness_damping) const {
  Eigen::VectorXd out = state.col(0) + stiffness_damping * state.col(1);
  for (std::size_t i = 0; i < branches_.size(); ++i)
    out += branches_[i].modulus * (state.col(0) - state.col(2 + static_cast<Eigen::Index>(i)));
  return out;
}

}  // namespace tissue_stiffness
