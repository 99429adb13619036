#include "estimation/agreement.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kTold = 0.25;  // of the prior's variance

}  // namespace

double Agreement::z() const {
  if (dof == 0) return 0.0;
  const double width = 2.0 / (9.0 * dof);
  return (std::cbrt(chi2 / dof) - (1.0 - width)) / std::sqrt(width);
}

// The unknowns are [w_1; w_2; eta].
Agreement agreement(const LinearFit& one, const LinearFit& others, const NormalPrior& prior) {
  const Eigen::Index p = prior.mean.size(), n = prior.nuisance_std.size(), all = 2 * p + n;
  Eigen::VectorXd precision(all), pull(all);
  const Eigen::VectorXd of_w = prior.std.cwiseAbs2().cwiseInverse();
  precision << of_w, of_w, prior.nuisance_std.cwiseAbs2().cwiseInverse();
  pull << of_w.cwiseProduct(prior.mean) + one.pull.head(p), of_w.cwiseProduct(prior.mean) + others.pull.head(p),
      one.pull.tail(n) + others.pull.tail(n);
  Eigen::MatrixXd information = precision.asDiagonal();
  information.bottomRightCorner(p + n, p + n) += others.information;
  information.topLeftCorner(p, p) += one.information.topLeftCorner(p, p);
  information.topRightCorner(p, n) += one.information.topRightCorner(p, n);
  information.bottomLeftCorner(n, p) += one.information.bottomLeftCorner(n, p);
  information.bottomRightCorner(n, n) += one.information.bottomRightCorner(n, n);

  Eigen::MatrixXd apart = Eigen::MatrixXd::Zero(p, all);  // w_1 - w_2 in standard deviations of the prior
  apart.leftCols(p) = (std::sqrt(0.5) * prior.std.cwiseInverse()).asDiagonal();
  apart.middleCols(p, p) = -apart.leftCols(p);
  const Eigen::LDLT<Eigen::MatrixXd> solver(information);
  const Eigen::VectorXd difference = apart * solver.solve(pull);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(apart * solver.solve(apart.transpose()));
  Agreement out;
  for (Eigen::Index i = 0; i < p; ++i) {
    const double left = axes.eigenvalues()[i];
    if (left > kTold) break;
    out.chi2 += std::pow(axes.eigenvectors().col(i).dot(difference), 2) / (left * (1.0 - left));
    ++out.dof;
  }
  return out;
}

}  // namespace tissue_stiffness
