#pragma once

#include "fem/sparse_solver.hpp"
#include "forward/full_model.hpp"

namespace tissue_stiffness {

/// Static displacement K u = f under the loads at time 0, at the prior's mean.
inline Eigen::VectorXd static_sag(const Model& model) {
  const Eigen::VectorXd theta = model.parameters().theta(model.parameters().prior_mean());
  const ModelSystem system(model, theta);
  SparseMatrix k = model.stiffness(theta);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(k.rows());
  Eigen::VectorXd f = system.force(0.0, zero, zero);
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    if (system.fixed()[static_cast<std::size_t>(i)] != 0) f[i] = 0.0;
  }
  fix_dofs(k, system.fixed(), k.diagonal().mean());
  SparseSolver solver;
  solver.factorize(k);
  return solver.solve(f);
}

}  // namespace tissue_stiffness
