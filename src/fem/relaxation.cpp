#include "fem/relaxation.hpp"

#include <cmath>

namespace tissue_stiffness {

RelaxationStep::RelaxationStep(const Relaxation& relaxation, double step) {
  const double x = step / relaxation.time_constant;
  decay = std::exp(-x);
  const double mean = -std::expm1(-x) / x;  // of exp over the step
  from = mean - decay;
  to = 1.0 - mean;
}

void relax(const std::vector<Relaxation>& branches, double step, const Eigen::VectorXd& u0, const Eigen::VectorXd& u1,
           std::vector<Eigen::VectorXd>& z) {
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const RelaxationStep s(branches[i], step);
    z[i] = s.decay * z[i] + s.from * u0 + s.to * u1;
  }
}

void overstretch(const std::vector<Relaxation>& branches, const Eigen::VectorXd& u, const std::vector<Eigen::VectorXd>& z,
                 Eigen::VectorXd& sum) {
  sum.setZero(u.size());
  for (std::size_t i = 0; i < branches.size(); ++i) sum += branches[i].modulus * (u - z[i]);
}

}  // namespace tissue_stiffness
