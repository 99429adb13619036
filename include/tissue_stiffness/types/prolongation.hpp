#pragma once

#include <Eigen/SparseCore>

namespace tissue_stiffness {

/// Values at a mesh's nodes of what is known at a coarser one's, nodes there x nodes here.
using Prolongation = Eigen::SparseMatrix<double, Eigen::RowMajor>;

}  // namespace tissue_stiffness
