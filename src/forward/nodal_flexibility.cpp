#include "forward/nodal_flexibility.hpp"

#include <cmath>
#include <utility>

namespace tissue_stiffness {
namespace {

constexpr double kSame = 1e-10;  // of the stiffness: rounding of its sum

}  // namespace

NodalFlexibility::NodalFlexibility(const SparseMatrix& stiffness, const std::vector<char>& fixed, std::vector<int> seen)
    : stiffness_(stiffness), fixed_(fixed), seen_(std::move(seen)) {
  SparseMatrix held = stiffness_;
  fix_dofs(held, fixed_, held.diagonal().mean());
  solver_.factorize(held);
}

NodalFlexibility::Columns NodalFlexibility::columns(const std::vector<int>& forced) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<int> missing;
  for (const int i : forced) {
    if (known_.count(i) == 0) missing.push_back(i);
  }
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(stiffness_.rows(), static_cast<Eigen::Index>(missing.size()));
  for (std::size_t k = 0; k < missing.size(); ++k) {
    const int dof = seen_[static_cast<std::size_t>(missing[k])];
    if (fixed_[static_cast<std::size_t>(dof)] == 0) loads(dof, static_cast<Eigen::Index>(k)) = 1.0;
  }
  if (!missing.empty()) loads = solver_.solve(loads);
  for (std::size_t k = 0; k < missing.size(); ++k) {
    Eigen::VectorXd column(static_cast<Eigen::Index>(seen_.size()));
    for (Eigen::Index i = 0; i < column.size(); ++i) {
      column[i] = loads(seen_[static_cast<std::size_t>(i)], static_cast<Eigen::Index>(k));
    }
    known_.emplace(missing[k], std::move(column));
  }
  Columns out;
  for (const int i : forced) out.push_back(&known_.at(i));
  return out;
}

Eigen::MatrixXd NodalFlexibility::between(const std::vector<int>& forced) const {
  const Columns columns = this->columns(forced);
  const auto count = static_cast<Eigen::Index>(forced.size());
  Eigen::MatrixXd out(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const Eigen::VectorXd& column = *columns[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < count; ++i) out(i, j) = column[forced[static_cast<std::size_t>(i)]];
  }
  return out;
}

Eigen::VectorXd NodalFlexibility::under(const std::vector<int>& forced, const Eigen::VectorXd& forces) const {
  const Columns columns = this->columns(forced);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(seen_.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) out += forces[static_cast<Eigen::Index>(j)] * *columns[j];
  return out;
}

Eigen::VectorXd NodalFlexibility::response(const Eigen::VectorXd& forces) const {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(stiffness_.rows());
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (fixed_[static_cast<std::size_t>(seen_[i])] == 0) load[seen_[i]] = forces[static_cast<Eigen::Index>(i)];
  }
  return solver_.solve(load);
}

double NodalFlexibility::ratio(const SparseMatrix& stiffness, const std::vector<char>& fixed) const {
  if (fixed != fixed_) return 0.0;
  const auto own = stiffness_.coeffs(), other = stiffness.coeffs();
  const double ratio = own.matrix().dot(other.matrix()) / own.matrix().squaredNorm();
  return (other - ratio * own).matrix().norm() < kSame * other.matrix().norm() ? ratio : 0.0;
}

}  // namespace tissue_stiffness
