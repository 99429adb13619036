#include "fem/node_corners.hpp"

#include <numeric>

namespace tissue_stiffness {

NodeCorners::NodeCorners(const Eigen::MatrixXi& elements, const std::vector<int>& list, int node_count)
    : first(static_cast<std::size_t>(node_count) + 1, 0) {
  const auto n = static_cast<int>(elements.rows());
  for (const int e : list) {
    for (int a = 0; a < n; ++a) ++first[static_cast<std::size_t>(elements(a, e)) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  corners.resize(list.size() * static_cast<std::size_t>(n));
  std::vector<int> next = first;
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (int a = 0; a < n; ++a) {
      int& at = next[static_cast<std::size_t>(elements(a, list[i]))];
      corners[static_cast<std::size_t>(at++)] = static_cast<int>(i) * n + a;
    }
  }
}

}  // namespace tissue_stiffness
