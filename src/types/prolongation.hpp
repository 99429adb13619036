#pragma once

#include <Eigen/SparseCore>

namespace tissue_stiffness {

/// Matrix that maps nodal values from a coarser mesh to a finer one: fine nodes x coarse nodes.
using Prolongation = Eigen::SparseMatrix<double, Eigen::RowMajor>;

}  // namespace tissue_stiffness
