#include "tissue_stiffness/fem/relaxation.hpp"

#include <cmath>

namespace tissue_stiffness {

RelaxationStep::RelaxationStep(const Relaxation& relaxation, double step) {
  const double x = step / relaxation.time_constant;
  decay = std::exp(-x);
  const double mean = -std::expm1(-x) / x;  // of exp over the step
  from = mean - decay;
  to = 1.0 - mean;
}

std::vector<Eigen::VectorXd> relax(const std::vector<Relaxation>& branches, double step, const Eigen::VectorXd& u0,
                                   const Eigen::VectorXd& u1, const std::vector<Eigen::VectorXd>& z0) {
  std::vector<Eigen::VectorXd> z1;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const RelaxationStep s(branches[i], step);
    z1.emplace_back(s.decay * z0[i] + s.from * u0 + s.to * u1);
  }
  return z1;
}

Eigen::VectorXd overstretch(const std::vector<Relaxation>& branches, const Eigen::VectorXd& u,
                            const std::vector<Eigen::VectorXd>& z) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(u.size());
  for (std::size_t i = 0; i < branches.size(); ++i) sum += branches[i].modulus * (u - z[i]);
  return sum;
}

}  // namespace tissue_stiffness
