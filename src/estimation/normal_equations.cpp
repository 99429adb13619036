#include "estimation/normal_equations.hpp"

namespace tissue_stiffness {

NormalEquations::NormalEquations(Eigen::Index size, Eigen::Index constant_count)
    : information(Eigen::MatrixXd::Zero(size, size)),
      gradient(Eigen::VectorXd::Zero(size)),
      constants(Eigen::MatrixXd::Zero(size, constant_count)),
      constants_information(Eigen::MatrixXd::Zero(constant_count, constant_count)),
      constants_gradient(Eigen::VectorXd::Zero(constant_count)) {}

void NormalEquations::repeat(double times) {
  information *= times;
  gradient *= times;
  constants *= times;
  constants_information *= times;
  constants_gradient *= times;
  cost *= times;
  rows *= times;
}

void NormalEquations::add(const NormalEquations& other, double times) {
  information += times * other.information;
  gradient += times * other.gradient;
  constants += times * other.constants;
  constants_information += times * other.constants_information;
  constants_gradient += times * other.constants_gradient;
  cost += times * other.cost;
  rows += times * other.rows;
}

}  // namespace tissue_stiffness
