#include "forward/quadratic_force.hpp"

namespace tissue_stiffness {

QuadraticForce::QuadraticForce(const Force& force, const Eigen::VectorXd& sizes) {
  const Eigen::Index m = sizes.size();
  at_rest_ = force(Eigen::VectorXd::Zero(m));
  linear_.resize(m, m);
  square_.resize(m, m * m);
  Eigen::MatrixXd along(m, m);  // change of the force along each coordinate
  for (Eigen::Index j = 0; j < m; ++j) {
    const Eigen::VectorXd step = sizes[j] * Eigen::VectorXd::Unit(m, j), back = force(-step) - at_rest_;
    along.col(j) = force(step) - at_rest_;
    linear_.col(j) = (along.col(j) - back) / (2.0 * sizes[j]);
    square_.col(j * m + j) = (along.col(j) + back) / (2.0 * sizes[j] * sizes[j]);
  }
  for (Eigen::Index j = 0; j < m; ++j) {
    for (Eigen::Index k = 0; k < j; ++k) {
      const Eigen::VectorXd both = sizes[j] * Eigen::VectorXd::Unit(m, j) + sizes[k] * Eigen::VectorXd::Unit(m, k);
      square_.col(j * m + k) = (force(both) - at_rest_ - along.col(j) - along.col(k)) / (2.0 * sizes[j] * sizes[k]);
      square_.col(k * m + j) = square_.col(j * m + k);
    }
  }
}

void QuadraticForce::add_force(double factor, const Eigen::VectorXd& q, Eigen::VectorXd& out) const {
  const Eigen::Index m = q.size();
  out += factor * at_rest_;
  out.noalias() += factor * linear_ * q;
  for (Eigen::Index j = 0; j < m; ++j) out.noalias() += (factor * q[j]) * (square_.middleCols(j * m, m) * q);
}

void QuadraticForce::add_stiffness(double factor, const Eigen::VectorXd& q, Eigen::MatrixXd& out) const {
  const Eigen::Index m = q.size();
  Eigen::MatrixXd tangent = linear_;
  for (Eigen::Index j = 0; j < m; ++j) tangent.col(j).noalias() += 2.0 * (square_.middleCols(j * m, m) * q);
  out -= (0.5 * factor) * (tangent + tangent.transpose());
}

}  // namespace tissue_stiffness
