#include "forward/orthogonal_decomposition.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace tissue_stiffness {

Eigen::MatrixXd most_energetic(const Eigen::MatrixXd& snapshots, const Eigen::MatrixXd& products, double energy_left,
                               Eigen::Index most) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(products);
  const Eigen::VectorXd& energy = eigen.eigenvalues();
  Eigen::Index count = 0;
  for (double left = energy.sum(); count < std::min(energy.size(), most); ++count) {
    if (left <= energy_left * energy.sum()) break;
    left -= energy[energy.size() - 1 - count];
  }
  return snapshots * eigen.eigenvectors().rightCols(count).rowwise().reverse();
}

}  // namespace tissue_stiffness
