#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// A Maxwell branch of a standard linear solid: force -modulus K (u - z) with time_constant z' = u - z. Under finite strain
/// u is Green's strain.
struct Relaxation {
  double modulus;        ///< relative to the elastic modulus [-]
  double time_constant;  ///< [s]
};

/// Exact change of z over a step in which u is linear in time: z1 = decay z0 + from u0 + to u1.
struct RelaxationStep {
  double decay, from, to;
  RelaxationStep(const Relaxation& relaxation, double step);
};

/// Advances z of every branch over a step from u0 to u1.
void relax(const std::vector<Relaxation>& branches, double step, const Eigen::VectorXd& u0, const Eigen::VectorXd& u1,
           std::vector<Eigen::VectorXd>& z);

/// Computes sum modulus (u - z), on which the branches' stiffness acts.
void overstretch(const std::vector<Relaxation>& branches, const Eigen::VectorXd& u, const std::vector<Eigen::VectorXd>& z,
                 Eigen::VectorXd& sum);

}  // namespace tissue_stiffness
