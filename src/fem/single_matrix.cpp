#include "fem/single_matrix.hpp"

#include <algorithm>

#include "fem/panel.hpp"

namespace tissue_stiffness {

SingleMatrix::SingleMatrix(const SparseMatrix& matrix) {
  const auto count = static_cast<std::size_t>(matrix.rows() / 3);
  std::vector<int> place(count);  // of this node's block with each other
  begin_.reserve(count + 1);
  others_.reserve(static_cast<std::size_t>(matrix.nonZeros() / 9));
  blocks_.reserve(static_cast<std::size_t>(matrix.nonZeros()));
  for (int node = 0; node < static_cast<int>(count); ++node) {
    const auto first = static_cast<std::ptrdiff_t>(others_.size());
    for (int i = 0; i < 3; ++i) {
      for (SparseMatrix::InnerIterator entry(matrix, 3 * node + i); entry; ++entry) {
        others_.push_back(static_cast<int>(entry.row() / 3));
      }
    }
    std::sort(others_.begin() + first, others_.end());
    others_.erase(std::unique(others_.begin() + first, others_.end()), others_.end());
    for (std::size_t k = static_cast<std::size_t>(first); k < others_.size(); ++k) {
      place[static_cast<std::size_t>(others_[k])] = static_cast<int>(k);
    }
    blocks_.resize(9 * others_.size(), 0.0F);
    for (int i = 0; i < 3; ++i) {
      for (SparseMatrix::InnerIterator entry(matrix, 3 * node + i); entry; ++entry) {
        const auto block = static_cast<std::size_t>(place[static_cast<std::size_t>(entry.row() / 3)]);
        blocks_[9 * block + static_cast<std::size_t>(3 * i + entry.row() % 3)] = static_cast<float>(entry.value());
      }
    }
    begin_.push_back(static_cast<int>(others_.size()));
  }
}

void SingleMatrix::multiply(int node, const float* x, long columns, float* y) const {
  const int first = begin_[static_cast<std::size_t>(node)];
  const auto at = static_cast<std::size_t>(first);
  sum_blocks(begin_[static_cast<std::size_t>(node) + 1] - first, blocks_.data() + 9 * at, others_.data() + at, x, columns,
             y);
}

}  // namespace tissue_stiffness
