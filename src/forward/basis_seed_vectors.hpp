#pragma once

#include <Eigen/Core>
#include <vector>

#include "forward/model.hpp"

namespace tissue_stiffness {

/// A linear model at two sets of parameters, for the choice of a reduced basis.
struct PriorView {
  /// `around` holds the filter's coordinates of the first set, and `reach` how far the second one is from there. Both are
  /// the prior's mean and standard deviation where they are empty.
  explicit PriorView(const Model& model, const Eigen::VectorXd& around = {}, const Eigen::VectorXd& reach = {});

  Eigen::VectorXd place, reach;  ///< [filter's coordinates]
  Eigen::VectorXd theta;         ///< the parameters at `place`, with every support held
  Eigen::VectorXd generic;       ///< away from there in every estimated parameter, by different shares of `reach`
};

/// Returns theta with the parameters of a part at their absent values.
Eigen::VectorXd theta_without_part(const Model& model, std::size_t part, Eigen::VectorXd theta);

/// These return nodal forces with 3n rows, one in each column. The first are active at the prior (gravity, loads, the
/// momentum of an initial velocity). The second are those of one part that are inactive there.
Eigen::MatrixXd acting_loads(const Model& model, const PriorView& prior, const SparseMatrix& mass);
Eigen::MatrixXd inactive_loads(const Model& model, const PriorView& prior, const SparseMatrix& mass, std::size_t part);

/// Returns the stiffness at the prior in groups whose ratio may change. It is empty when they all scale together.
std::vector<SparseMatrix> stiffness_groups(const Model& model, const PriorView& prior);

/// Returns the stiffness of each part that is zero at the prior, at parameters away from it.
std::vector<SparseMatrix> inactive_stiffness(const Model& model, const PriorView& prior);

/// Returns whether one of the next two functions can return a column.
bool answers_motion(const Model& model, const PriorView& prior, std::size_t part);

/// Returns the forces of a part's inactive or shape-dependent terms when the body moves as the columns of u: dK u and dM u,
/// 3n each.
Eigen::MatrixXd inactive_forces(const Model& model, const PriorView& prior, std::size_t part, const Eigen::MatrixXd& u,
                                const StrainRows& strains);

/// Returns the forces of a nonlinear part when the body moves as the columns of u and as their sums and differences, scaled
/// to moderate strain; 3n each.
Eigen::MatrixXd extra_forces(const Model& model, const PriorView& prior, std::size_t part, const Eigen::MatrixXd& u,
                             const StrainRows& strains);

}  // namespace tissue_stiffness
