#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <vector>

#include "fem/discretisation.hpp"
#include "fem/node_corners.hpp"
#include "fem/vector_pool.hpp"

namespace tissue_stiffness {

/// Nodal vectors of an element with N nodes, one in each column.
template <int N>
using Nodal = Eigen::Matrix<double, 3, N>;

template <int N>
Nodal<N> gather(const Eigen::MatrixXi& elements, int e, const Eigen::VectorXd& u) {
  Nodal<N> local;
  for (int a = 0; a < N; ++a) local.col(a) = u.segment<3>(3 * elements(a, e));
  return local;
}

/// Subtracts internal forces [N] from f (3n): internal(e) is that of element e, for each of the listed `elements`. Elements
/// are processed in parallel, and then nodes. Each node sums its parts in a fixed order, whatever the threads do.
template <int N, typename Internal>
void subtract_element_forces(const std::vector<int>& elements, const NodeCorners& corners, int node_count,
                             VectorPool& scratch, const Internal& internal, Eigen::VectorXd& f) {
  constexpr int element_grain = 64, node_grain = 512;  // worth a task
  VectorPool::Loan shares(scratch, 3 * static_cast<Eigen::Index>(corners.corners.size()));
  const auto count = static_cast<int>(elements.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, count, element_grain), [&](const tbb::blocked_range<int>& part) {
    for (int i = part.begin(); i < part.end(); ++i) {
      Eigen::Map<Nodal<N>>(shares->data() + static_cast<std::ptrdiff_t>(3 * N) * i) =
          internal(elements[static_cast<std::size_t>(i)]);
    }
  });
  tbb::parallel_for(tbb::blocked_range<int>(0, node_count, node_grain), [&](const tbb::blocked_range<int>& part) {
    for (int node = part.begin(); node < part.end(); ++node) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      const auto at = static_cast<std::size_t>(node);
      for (int k = corners.first[at]; k < corners.first[at + 1]; ++k) {
        sum += shares->segment<3>(3 * static_cast<Eigen::Index>(corners.corners[static_cast<std::size_t>(k)]));
      }
      f.segment<3>(3 * node) -= sum;
    }
  });
}

}  // namespace tissue_stiffness
