#include "tissue_stiffness/forward/reduced_model.hpp"

#include <cmath>

#include "tissue_stiffness/fem/sparse_solver.hpp"
#include "tissue_stiffness/forward/reduced_trajectory.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kDependent = 1e-7;  // a candidate that loses this much of its norm to the basis is no new direction
constexpr double kShift = 1e-3;      // of a free body's smallest elastic frequency squared, makes K invertible

Eigen::MatrixX3d uniform_motion(const std::vector<char>& fixed) {
  Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(fixed.size()), 3);
  for (Eigen::Index i = 0; i < u.rows(); ++i) u(i, i % 3) = fixed[static_cast<std::size_t>(i)] != 0 ? 0.0 : 1.0;
  return u;
}

void zero_fixed(Eigen::MatrixXd& x, const std::vector<char>& fixed) {
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    if (fixed[static_cast<std::size_t>(i)] != 0) x.row(i).setZero();
  }
}

// Gram-Schmidt, twice, in the inner product of M.
class OrthonormalBasis {
 public:
  OrthonormalBasis(const SparseMatrix& mass, int capacity) : mass_(mass), vectors_(mass.rows(), capacity) {}

  bool full() const { return size_ == vectors_.cols(); }
  int size() const { return size_; }
  auto vectors() const { return vectors_.leftCols(size_); }

  bool add(Eigen::VectorXd x) {
    if (full()) return false;
    const double before = std::sqrt(x.dot(mass_ * x));
    if (!(before > 0.0)) return false;
    x /= before;
    for (int pass = 0; pass < 2; ++pass) x -= vectors() * (vectors().transpose() * (mass_ * x)).eval();
    const double after = std::sqrt(x.dot(mass_ * x));
    if (!(after > kDependent)) return false;
    vectors_.col(size_++) = x / after;
    return true;
  }

 private:
  const SparseMatrix& mass_;
  Eigen::MatrixXd vectors_;
  int size_ = 0;
};

}  // namespace

ReducedModel::ReducedModel(const Model& model, int basis_size) : model_(model) {
  if (model.nonlinear()) throw InputError("model", "a nonlinear effect", "linear effects only, in a reduced basis");
  build_basis(basis_size);
  project();
}

Eigen::MatrixXd ReducedModel::start_vectors(const SparseMatrix& mass) const {
  const Eigen::VectorXd theta = model_.theta(model_.prior_mean());
  Eigen::MatrixXd patterns(model_.fem().dof_count(), 0);
  const auto append = [&patterns](const Eigen::VectorXd& x) {
    patterns.conservativeResize(Eigen::NoChange, patterns.cols() + 1);
    patterns.rightCols<1>() = x;
  };
  const Eigen::MatrixX3d uniform = uniform_motion(model_.fixed());
  const auto& free = model_.free_parameters();
  bool unknown_acceleration = false;
  for (const auto& parameter : free) {
    unknown_acceleration = unknown_acceleration || parameter.name.find(".acceleration_") != std::string::npos;
  }
  const Eigen::Vector3d gravity = model_.body_acceleration(theta);
  if (unknown_acceleration) {
    for (int i = 0; i < 3; ++i) append(mass * uniform.col(i));
  } else if (gravity.norm() > 0.0) {
    append(mass * (uniform * gravity));
  }
  for (const auto& part : model_.parts()) {
    for (const auto& term : part.terms.loads) append(term.pattern);
  }
  const bool moving = model_.settings().initial.kind != InitialSettings::Kind::rest;
  for (int i = 0; moving && i < 3; ++i) append(mass * uniform.col(i));
  if (patterns.cols() == 0) {
    throw InputError(model_.settings().name + ": effects", "nothing that moves the body",
                     "gravity, pressure, traction or an initial velocity");
  }
  return patterns;
}

void ReducedModel::build_basis(int size) {
  const Eigen::VectorXd theta = model_.theta(model_.prior_mean());
  const SparseMatrix mass = model_.mass(theta);
  SparseMatrix stiffness = model_.stiffness(theta);
  bool held = false;
  for (const char flag : model_.fixed()) held = held || flag != 0;
  if (!held) stiffness += kShift * stiffness.diagonal().sum() / mass.diagonal().sum() * 1e-3 * mass;
  std::vector<SparseMatrix> regional;  // K_r of each elasticity when their ratios may change
  for (const auto& part : model_.parts()) {
    if (part.terms.stiffness.empty()) continue;
    SparseMatrix k = model_.fem().pattern();
    for (const auto& term : part.terms.stiffness) k += term.coefficient(part.parameters(theta)) * term.matrix;
    regional.push_back(std::move(k));
  }
  if (regional.size() == 1) regional.clear();
  fix_dofs(stiffness, model_.fixed(), stiffness.diagonal().mean());
  SparseSolver solver;
  solver.factorize(stiffness);

  OrthonormalBasis basis(mass, std::min(size, model_.fem().dof_count() / 2));
  const auto extend = [&](Eigen::MatrixXd loads) {
    zero_fixed(loads, model_.fixed());
    const Eigen::MatrixXd x = solver.solve(loads);
    const int before = basis.size();
    for (Eigen::Index i = 0; i < x.cols(); ++i) basis.add(x.col(i));
    return Eigen::MatrixXd(basis.vectors().rightCols(basis.size() - before));
  };
  Eigen::MatrixXd block = extend(start_vectors(mass));
  while (!basis.full() && block.cols() > 0) {
    Eigen::MatrixXd loads = mass * block;
    for (const SparseMatrix& k : regional) {
      loads.conservativeResize(Eigen::NoChange, loads.cols() + block.cols());
      loads.rightCols(block.cols()) = k * block;
    }
    block = extend(std::move(loads));
  }
  basis_ = basis.vectors();
}

void ReducedModel::project() {
  const Eigen::MatrixX3d uniform = uniform_motion(model_.fixed());
  for (const auto& part : model_.parts()) {
    mass_.emplace_back();
    stiffness_.emplace_back();
    loads_.emplace_back();
    uniform_.emplace_back();
    for (const auto& term : part.terms.mass) {
      const Eigen::MatrixXd mb = term.matrix * basis_;
      mass_.back().push_back(basis_.transpose() * mb);
      uniform_.back().push_back(mb.transpose() * uniform);
    }
    for (const auto& term : part.terms.stiffness) stiffness_.back().push_back(basis_.transpose() * (term.matrix * basis_));
    for (const auto& term : part.terms.loads) loads_.back().push_back(basis_.transpose() * term.pattern);
  }
}

std::unique_ptr<Trajectory> ReducedModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<ReducedTrajectory>(*this, theta, start);
}

std::string ReducedModel::description() const {
  return "reduced: " + std::to_string(basis_.cols()) + " load-dependent Ritz vectors for " + std::to_string(basis_.rows()) +
         " degrees of freedom, exact in time";
}

}  // namespace tissue_stiffness
