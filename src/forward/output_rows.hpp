#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/products.hpp"
#include "fem/vector_pool.hpp"

namespace tissue_stiffness {

/// Computes out = tall * small for blocks of rows in parallel, so that the tall matrix is read once.
void multiply_tall(const Eigen::MatrixXd& tall, const Eigen::MatrixXd& small, Eigen::Ref<Eigen::MatrixXd> out);

/// Returns the basis (3n x m) at some nodes, three rows for each.
Eigen::MatrixXd basis_rows(const Eigen::MatrixXd& basis, const std::vector<int>& nodes);

/// Nodes whose motion an output needs, ascending; absent: all nodes. Forces alone need none.
using OutputNodes = std::optional<std::vector<int>>;

/// The rows of a basis that an output needs.
class OutputRows {
 public:
  void restrict_to(const Eigen::MatrixXd& basis, const OutputNodes& nodes);
  const OutputNodes& nodes() const { return nodes_; }
  /// Computes the displacements of several columns of coordinates. Rows of `out` that do not belong to the output are not
  /// changed. Thread safe.
  void displacements(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& coordinates, Eigen::MatrixXd& out) const;

 private:
  OutputNodes nodes_;
  PackedMatrix rows_;
  mutable VectorPool scratch_;
};

}  // namespace tissue_stiffness
