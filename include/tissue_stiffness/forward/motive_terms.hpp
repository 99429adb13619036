#pragma once

#include <Eigen/Core>
#include <vector>

#include "tissue_stiffness/forward/model.hpp"

namespace tissue_stiffness {

/// The prior of a linear model, taken apart for the choice of a reduced basis.
struct PriorView {
  explicit PriorView(const Model& model);

  Eigen::VectorXd theta;    ///< at the prior, every support held
  Eigen::VectorXd generic;  ///< away from it in every estimated parameter, by different amounts
};

/// theta with the parameters of a part at their absent values.
Eigen::VectorXd without(const Model& model, std::size_t part, Eigen::VectorXd theta);

/// Nodal forces that act at the prior (gravity, loads, the push of an initial velocity), 3n a column, and those that do not
/// yet, part by part.
Eigen::MatrixXd acting_loads(const Model& model, const PriorView& prior, const SparseMatrix& mass);
Eigen::MatrixXd sleeping_loads(const Model& model, const PriorView& prior, const SparseMatrix& mass, std::size_t part);

/// Stiffness at the prior in groups whose ratio may change; empty when they all scale together.
std::vector<SparseMatrix> stiffness_groups(const Model& model, const PriorView& prior);

/// Stiffness of each part that is zero at the prior, away from it.
std::vector<SparseMatrix> sleeping_stiffness(const Model& model, const PriorView& prior);

/// Whether one of the next two can have a column.
bool answers_motion(const Model& model, const PriorView& prior, std::size_t part);

/// Forces of a part's sleeping or movable terms when the body moves as the columns of u: dK u and dM u, 3n each.
Eigen::MatrixXd sleeping_forces(const Model& model, const PriorView& prior, std::size_t part, const Eigen::MatrixXd& u,
                                const StrainRows& strains);

/// Forces of a part that is not linear when the body moves as the columns of u and as their sums and differences, scaled to
/// moderate strain; 3n each.
Eigen::MatrixXd extra_forces(const Model& model, const PriorView& prior, std::size_t part, const Eigen::MatrixXd& u,
                             const StrainRows& strains);

}  // namespace tissue_stiffness
