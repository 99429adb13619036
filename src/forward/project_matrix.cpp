#include "forward/project_matrix.hpp"

#include <vector>

#include "fem/products.hpp"

namespace tissue_stiffness {

Eigen::MatrixXd project_matrix(const SparseMatrix& k, const Eigen::MatrixXd& basis) {
  std::vector<int> rows;
  for (int j = 0; j < k.outerSize(); ++j) {
    if (SparseMatrix::InnerIterator(k, j)) rows.push_back(j);
  }
  if (static_cast<Eigen::Index>(rows.size()) == k.rows()) return inner_products(basis, symmetric_product(k, basis));
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd own(count, basis.cols()), product = Eigen::MatrixXd::Zero(count, basis.cols());
  std::vector<Eigen::Index> place(static_cast<std::size_t>(k.rows()), -1);
  for (Eigen::Index i = 0; i < count; ++i) {
    own.row(i) = basis.row(rows[static_cast<std::size_t>(i)]);
    place[static_cast<std::size_t>(rows[static_cast<std::size_t>(i)])] = i;
  }
  for (Eigen::Index j = 0; j < count; ++j) {
    for (SparseMatrix::InnerIterator entry(k, rows[static_cast<std::size_t>(j)]); entry; ++entry) {
      product.row(place[static_cast<std::size_t>(entry.row())]) += entry.value() * own.row(j);
    }
  }
  return own.transpose() * product;
}

Eigen::MatrixX3d unit_motion(Eigen::Index dofs) {
  return Eigen::Matrix3d::Identity().replicate(dofs / 3, 1);
}

}  // namespace tissue_stiffness
