#include "estimation/input_posterior.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace tissue_stiffness {
namespace {

using Values = std::function<Eigen::VectorXd(const Eigen::VectorXd& z)>;

// Returns the rows y - h(z) of unit noise, with h's derivatives by differences; a row's weight may fall with its error.
InputPosterior::Rows rows_of(const Values& h, const Eigen::VectorXd& y, double robust = 1e9) {
  return [=](const Eigen::VectorXd& z, Constants) {
    NormalEquations out(z.size(), 0);
    Eigen::MatrixXd slope(y.size(), z.size());
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const Eigen::VectorXd step = 1e-5 * Eigen::VectorXd::Unit(z.size(), i);
      slope.col(i) = (h(z + step) - h(z - step)) / 2e-5;
    }
    const Eigen::VectorXd error = y - h(z);
    const Eigen::VectorXd weight = (1.0 + error.array().square() / (robust * robust)).inverse();
    out.information = slope.transpose() * weight.asDiagonal() * slope;
    out.gradient = slope.transpose() * weight.cwiseProduct(error);
    out.cost = error.dot(weight.cwiseProduct(error));
    out.rows = static_cast<double>(y.size());
    return InputPosterior::Equations{out};
  };
}

// Returns mean and variance of z[0] by brute force: z[1] takes its most probable value on a fine grid of its own.
Eigen::Vector2d brute_force(const Values& h, const Eigen::VectorXd& y, double prior_std, double nuisance_std) {
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  double least = 1e300;
  std::vector<std::pair<double, double>> costs;
  for (double w = -3.0; w <= 3.0; w += 0.005) {
    double best = 1e300;
    for (double eta = -6.0; eta <= 6.0; eta += 0.01) {
      const double cost = (y - h(Eigen::Vector2d(w, eta))).squaredNorm() + w * w / (prior_std * prior_std) +
                          eta * eta / (nuisance_std * nuisance_std);
      best = std::min(best, cost);
    }
    costs.emplace_back(w, best);
    least = std::min(least, best);
  }
  for (const auto& [w, cost] : costs) sums += std::exp(0.5 * (least - cost)) * Eigen::Vector3d(1.0, w, w * w);
  const double mean = sums[1] / sums[0];
  return {mean, sums[2] / sums[0] - mean * mean};
}

InputPosterior posterior(const InputPosterior::Rows& rows, double prior_std, double nuisance_std) {
  return {rows, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, prior_std),
          Eigen::VectorXd::Constant(1, nuisance_std)};
}

// y = X w + C c: a joint fit of both says which c is most probable, and by how much w moves with it.
TEST(InputPosterior, ToleratesWhatConstantsLeave) {
  const Eigen::Vector4d x(3.0, 1.0, -2.0, 0.5), c(1.0, 2.0, 0.3, -4.0), y = 0.2 * x + 0.2 * c;
  const auto rows = [&](const Eigen::VectorXd& z, Constants constants) {
    NormalEquations out(1, 1);
    const Eigen::Vector4d error = y - x * z[0];
    out.information(0, 0) = x.squaredNorm();
    out.gradient[0] = x.dot(error);
    if (constants == Constants::varied) {
      out.constants(0, 0) = x.dot(c);
      out.constants_information(0, 0) = c.squaredNorm();
      out.constants_gradient[0] = c.dot(error);
    }
    out.cost = error.squaredNorm();
    out.rows = 4.0;
    return InputPosterior::Equations{out};
  };
  InputPosterior p(rows, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, 2.0), Eigen::VectorXd(0));
  const InputPosterior::Fit mode = p.mode(Eigen::VectorXd::Zero(1));
  const double s = p.scales(mode.normal)[0];
  Eigen::Matrix2d joint;
  joint << x.squaredNorm() / s + 0.25, x.dot(c) / s, x.dot(c) / s, c.squaredNorm() / s + 1.0 / kTails;
  const Eigen::Vector2d both = joint.ldlt().solve(Eigen::Vector2d(x.dot(y), c.dot(y)) / s);
  const InputPosterior::Tolerated tolerated = p.tolerated(mode.normal);
  EXPECT_NEAR(tolerated.constants[0], both[1], 1e-9);
  EXPECT_NEAR(mode.z[0] + tolerated.z[0], both[0], 1e-9);
}

TEST(InputPosterior, IsNormalForLinearRows) {
  Eigen::MatrixXd z(3, 2);
  z << 1.0, 0.4, 2.0, -0.3, 0.5, 1.5;
  const Eigen::Vector3d y(0.7, -0.2, 1.1);
  InputPosterior p = posterior(rows_of([&](const Eigen::VectorXd& at) { return z * at; }, y), 1.0, 0.5);
  const InputPosterior::Fit mode = p.mode(Eigen::VectorXd::Zero(1));
  const Eigen::Matrix2d information = z.transpose() * z + Eigen::Matrix2d(Eigen::Vector2d(1.0, 4.0).asDiagonal());
  EXPECT_LT((mode.z - information.inverse() * (z.transpose() * y)).norm(), 1e-6);
  const InputPosterior::Moments moments = p.integrate(mode);
  EXPECT_LT((moments.mean.z - mode.z).norm(), 0.01);
  EXPECT_LT((p.covariance(moments.mean.normal) + moments.beyond_linear - information.inverse()).norm(), 0.02);
}

// The phase of a swing determines w up to a multiple of a period. So there are many maxima, each far narrower than the
// posterior.
TEST(InputPosterior, SumsOverTheMaximaOfAComb) {
  const Values h = [](const Eigen::VectorXd& z) {
    return Eigen::Vector3d(5.0 * (z[0] + z[1]), 3.0 * std::sin(12.0 * z[0]), z[1]);
  };
  const Eigen::Vector3d y(0.0, 0.0, 0.0);
  InputPosterior p = posterior(rows_of(h, y), 1.0, 0.4);
  const InputPosterior::Moments moments = p.integrate(p.mode(Eigen::VectorXd::Constant(1, 0.01)));
  const Eigen::Vector2d truth = brute_force(h, y, 1.0, 0.4);
  const double variance = p.covariance(moments.mean.normal)(0, 0) + moments.beyond_linear(0, 0);
  EXPECT_NEAR(moments.mean.z[0], truth[0], 0.1 * std::sqrt(truth[1]));
  EXPECT_NEAR(std::sqrt(variance / truth[1]), 1.0, 0.1);
  EXPECT_GT(variance, 16.0 * p.covariance(p.mode(Eigen::VectorXd::Constant(1, 0.01)).normal)(0, 0));
}

// A load's gain and the modulus compensate each other, far along a bent valley. Off the valley errors are so large that
// robust weights drop most of their rows. So the costs are those at the valley's floor.
TEST(InputPosterior, FollowsAValleyWhoseSidesAreRobust) {
  const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(40, -30.0, 30.0);
  const Values h = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd { return load * (1.0 - 0.3 * z[1]) * std::exp(-z[0]); };
  const Eigen::VectorXd y = load;
  InputPosterior p = posterior(rows_of(h, y, 3.0), 1.0, 1.0);
  const InputPosterior::Moments moments = p.integrate(p.mode(Eigen::VectorXd::Constant(1, 0.1)));
  const Eigen::Vector2d truth = brute_force(h, y, 1.0, 1.0);
  const double variance = p.covariance(moments.mean.normal)(0, 0) + moments.beyond_linear(0, 0);
  EXPECT_NEAR(moments.mean.z[0], truth[0], 0.1 * std::sqrt(truth[1]));
  EXPECT_NEAR(std::sqrt(variance / truth[1]), 1.0, 0.15);
}

TEST(InputPosterior, AHotLikelihoodLeavesThePrior) {
  const Values h = [](const Eigen::VectorXd& z) { return Eigen::Vector2d(10.0 * z[0], z[1]); };
  InputPosterior p = posterior(rows_of(h, Eigen::Vector2d(20.0, 0.0)), 0.5, 1.0);
  p.set_temperature(0, 1e6);
  const InputPosterior::Fit mode = p.mode(Eigen::VectorXd::Zero(1));
  EXPECT_NEAR(mode.z[0], 0.0, 1e-3);
  EXPECT_NEAR(p.covariance(mode.normal)(0, 0), 0.25, 1e-3);
  EXPECT_NEAR(p.learnt(p.covariance(mode.normal), 1), 0.0, 1e-5);
}

}  // namespace
}  // namespace tissue_stiffness
