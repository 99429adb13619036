#include "tissue_stiffness/forward/modal_step.hpp"

#include <cmath>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSameStep = 1e-11;  // [s]

constexpr int kMostBranches = 6;
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostBranches + 4, kMostBranches + 4>;

Small exponential(const Small& a) {
  if (a.rows() != 4) return a.exp();
  const Eigen::Matrix4d fixed = a;
  return Small(fixed.exp());
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
  Small a(n + 2, n + 2);
  for (Eigen::Index mode = 0; mode < square_.size(); ++mode) {
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
    const Small e = exponential(a);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n + 2; ++j) entry(i, j)[mode] = j == f ? e(i, f) - e(i, f + 1) : e(i, j);
    }
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

}  // namespace tissue_stiffness
