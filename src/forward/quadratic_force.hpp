#pragma once

#include <Eigen/Core>
#include <functional>

namespace tissue_stiffness {

/// A force in a basis that is a polynomial of second degree in the coordinates, f(q) = f0 + L q + Q (q x q). It is exact:
/// nothing of the force is sampled.
class QuadraticForce {
 public:
  using Force = std::function<Eigen::VectorXd(const Eigen::VectorXd& q)>;
  /// Finds the coefficients from values of the force (polarization). `sizes` holds the typical size of each coordinate, by
  /// which they are scaled.
  QuadraticForce(const Force& force, const Eigen::VectorXd& sizes);

  /// Adds `factor` times the force.
  void add_force(double factor, const Eigen::VectorXd& q, Eigen::VectorXd& out) const;
  /// Adds the symmetric part of -d force / d q, times `factor`.
  void add_stiffness(double factor, const Eigen::VectorXd& q, Eigen::MatrixXd& out) const;

 private:
  Eigen::VectorXd at_rest_;  ///< f0
  Eigen::MatrixXd linear_;   ///< L
  Eigen::MatrixXd square_;   ///< Q, m x m^2: columns j m + k and k m + j are equal
};

}  // namespace tissue_stiffness
