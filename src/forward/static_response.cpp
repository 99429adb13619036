#include "forward/static_response.hpp"

#include <algorithm>
#include <utility>

namespace tissue_stiffness {
namespace {

constexpr double kShift = 1e-6;        // makes the stiffness of a body that nothing holds invertible
constexpr Eigen::Index kLarge = 6000;  // unknowns from which on single precision is faster, and so is another mesh's help

}  // namespace

StaticResponse::StaticResponse(SparseMatrix stiffness, const SparseMatrix& mass, std::vector<char> fixed,
                               const Prolongation* coarser)
    : fixed_(std::move(fixed)) {
  const bool held = std::any_of(fixed_.begin(), fixed_.end(), [](char flag) { return flag != 0; });
  if (!held) stiffness += kShift * stiffness.diagonal().sum() / mass.diagonal().sum() * mass;
  fix_dofs(stiffness, fixed_, stiffness.diagonal().mean());
  if (coarser != nullptr && stiffness.rows() > kLarge) {
    grids_ = std::make_unique<const TwoGrid>(std::move(stiffness), fixed_, *coarser);
  } else {
    solver_.factorize(stiffness);
    factorised_ = true;
  }
}

Eigen::MatrixXd StaticResponse::operator()(Eigen::MatrixXd loads) const {
  hold(loads);
  if (std::optional<Eigen::MatrixXd> found = between_meshes(loads)) return *std::move(found);
  return solver_.solve(loads);
}

Eigen::MatrixXd StaticResponse::roughly(Eigen::MatrixXd loads) const {
  hold(loads);
  if (std::optional<Eigen::MatrixXd> found = between_meshes(loads)) return *std::move(found);
  return loads.rows() < kLarge ? solver_.solve(loads) : solver_.solve_roughly(loads);
}

void StaticResponse::hold(Eigen::MatrixXd& loads) const {
  for (Eigen::Index i = 0; i < loads.rows(); ++i) {
    if (fixed_[static_cast<std::size_t>(i)] != 0) loads.row(i).setZero();
  }
}

// Returns nothing where there is a factor. A factor is made where the conjugate gradients take too long.
std::optional<Eigen::MatrixXd> StaticResponse::between_meshes(const Eigen::MatrixXd& loads) const {
  if (factorised_) return std::nullopt;
  if (std::optional<Eigen::MatrixXd> found = grids_->solve(loads)) return found;
  const std::lock_guard<std::mutex> lock(busy_);
  if (!factorised_) solver_.factorize(grids_->matrix());
  factorised_ = true;
  return std::nullopt;
}

}  // namespace tissue_stiffness
