#include "fem/generalized_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// A chain of n masses between two walls: omega_j^2 = 4 k / m sin^2(j pi / (2 n + 2)).
TEST(GeneralizedModes, AreThoseOfAChainOfMasses) {
  constexpr int n = 60;
  constexpr double mass = 0.3, spring = 70.0;
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  k.diagonal().setConstant(2.0 * spring);
  k.diagonal(-1).setConstant(-spring);  // only the lower triangle is read
  const Eigen::MatrixXd m = mass * Eigen::MatrixXd::Identity(n, n);
  const GeneralizedModes modes = generalized_modes(k, m);
  for (int j = 0; j < n; ++j) {
    const double square = 4.0 * spring / mass * std::pow(std::sin((j + 1) * M_PI / (2 * n + 2)), 2);
    EXPECT_NEAR(modes.values[j], square, 1e-9 * spring / mass) << j;
  }
}

TEST(GeneralizedModes, AreOrthonormalInTheMass) {
  constexpr int n = 40;
  Eigen::MatrixXd m = Eigen::MatrixXd::Identity(n, n), k = 2.0 * m;
  for (int i = 0; i < n; ++i) {
    m(i, i) += 0.1 * i;
    k(i, i) += std::sin(i);
    if (i > 0) m(i, i - 1) = m(i - 1, i) = 0.3;
    if (i > 0) k(i, i - 1) = k(i - 1, i) = -0.4;
  }
  const GeneralizedModes modes = generalized_modes(k, m);
  EXPECT_LT((modes.vectors.transpose() * m * modes.vectors - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-10);
  EXPECT_LT((k * modes.vectors - m * modes.vectors * modes.values.asDiagonal()).norm(), 1e-10);
}

TEST(GeneralizedModes, NeedAPositiveMass) {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Identity(3, 3);
  mass(1, 1) = -1.0;
  EXPECT_THROW(generalized_modes(Eigen::MatrixXd::Identity(3, 3), mass), NumericalError);
  EXPECT_EQ(generalized_modes(Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 0)).values.size(), 0);
}

}  // namespace
}  // namespace tissue_stiffness
