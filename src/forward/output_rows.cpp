#include "forward/output_rows.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace tissue_stiffness {

void multiply_tall(const Eigen::MatrixXd& tall, const Eigen::MatrixXd& small, Eigen::Ref<Eigen::MatrixXd> out) {
  constexpr Eigen::Index block = 1024;
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, tall.rows(), block), [&](const auto& part) {
    const Eigen::Index count = part.end() - part.begin();
    out.middleRows(part.begin(), count).noalias() = tall.middleRows(part.begin(), count) * small;
  });
}

Eigen::MatrixXd basis_rows(const Eigen::MatrixXd& basis, const std::vector<int>& nodes) {
  Eigen::MatrixXd rows(3 * static_cast<Eigen::Index>(nodes.size()), basis.cols());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    rows.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = basis.middleRows<3>(3 * nodes[i]);
  }
  return rows;
}

void OutputRows::restrict_to(const Eigen::MatrixXd& basis, const OutputNodes& nodes) {
  nodes_ = nodes;
  rows_ = PackedMatrix(nodes ? basis_rows(basis, *nodes) : Eigen::MatrixXd(0, basis.cols()));
}

void OutputRows::displacements(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& coordinates,
                               Eigen::MatrixXd& out) const {
  if (!nodes_) return multiply_tall(basis, coordinates, out.topLeftCorner(basis.rows(), coordinates.cols()));
  if (nodes_->empty()) return;
  VectorPool::Loan scratch(scratch_, rows_.rows() * coordinates.cols());
  Eigen::Map<Eigen::MatrixXd> seen(scratch->data(), rows_.rows(), coordinates.cols());
  rows_.multiply(coordinates, seen);
  for (Eigen::Index k = 0; k < seen.cols(); ++k) {
    for (std::size_t i = 0; i < nodes_->size(); ++i) {
      out.block<3, 1>(3 * (*nodes_)[i], k) = seen.block<3, 1>(3 * static_cast<Eigen::Index>(i), k);
    }
  }
}

}  // namespace tissue_stiffness
