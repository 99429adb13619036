#include "estimation/fit_alone.hpp"

#include <Eigen/Cholesky>
#include <vector>

namespace tissue_stiffness {
namespace {

constexpr int kOwnSteps = 4;    // of Gauss-Newton
constexpr double kNoise = 2.0;  // mean square over the noise's below which no other start is tried

}  // namespace

LinearFit fit_alone(const JointRows& rows, std::size_t recording, const Eigen::VectorXd& z, MisfitTest& test) {
  const Eigen::Index p = rows.parameters().size();
  InputPosterior posterior(
      [&](const Eigen::VectorXd& at, Constants constants) {
        return InputPosterior::Equations{rows.of(recording, at, constants)};
      },
      rows.parameters().prior_mean(), rows.prior_std(), rows.nuisance_std());
  InputPosterior::Fit best = posterior.mode(z.head(p));
  if (posterior.scales(best.normal)[0] > kNoise) {
    InputPosterior::Fit other = posterior.mode(rows.parameters().prior_mean());
    const Eigen::VectorXd s = posterior.scales(best.normal).cwiseMin(posterior.scales(other.normal));
    if (posterior.cost(other, s) < posterior.cost(best, s)) best = other;
  }
  const auto tested = [&] {
    const Eigen::MatrixXd information = posterior.sum(best.normal, posterior.scales(best.normal)).information;
    const double fitted = posterior.covariance(best.normal).cwiseProduct(information).sum();
    return rows.test(recording, best.z, fitted, posterior.tolerated(best.normal));
  };
  test = tested();
  if (posterior.nuisance_count() > 0) {
    posterior.set_temperature(0, rows.temperature(recording, test));
    best = posterior.mode(best.z.head(p));
    test = tested();
  }
  const NormalEquations normal = posterior.sum(best.normal, posterior.scales(best.normal));
  return {normal.information, normal.information * best.z + normal.gradient};
}

Eigen::VectorXd with_own_parameters(const JointRows& rows, std::size_t recording, Eigen::VectorXd z) {
  std::vector<Eigen::Index> own;
  for (const Eigen::Index i : rows.parameters().columns(recording)) {
    if (rows.parameters().all()[static_cast<std::size_t>(i)].recording == static_cast<int>(recording)) own.push_back(i);
  }
  const Eigen::VectorXd mean = rows.parameters().prior_mean(), precision = rows.prior_std().cwiseAbs2().cwiseInverse();
  const auto count = static_cast<Eigen::Index>(own.size());
  for (int step = 0; step < kOwnSteps && count > 0; ++step) {
    const NormalEquations normal = rows.of(recording, z, Constants::held);
    Eigen::MatrixXd information(count, count);
    Eigen::VectorXd pull(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index at = own[static_cast<std::size_t>(i)];
      for (Eigen::Index j = 0; j < count; ++j) information(i, j) = normal.information(at, own[static_cast<std::size_t>(j)]);
      information(i, i) += precision[at];
      pull[i] = normal.gradient[at] + precision[at] * (mean[at] - z[at]);
    }
    const Eigen::VectorXd move = information.ldlt().solve(pull);
    for (Eigen::Index i = 0; i < count; ++i) z[own[static_cast<std::size_t>(i)]] += move[i];
  }
  return z;
}

}  // namespace tissue_stiffness
