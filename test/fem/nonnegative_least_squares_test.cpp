#include "fem/nonnegative_least_squares.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tissue_stiffness {
namespace {

Eigen::MatrixXd drawn(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(engine); });
}

TEST(NonnegativeLeastSquares, FindsTheWeightsThatMadeTheSum) {
  const Eigen::MatrixXd a = drawn(40, 25, 1);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(25);
  x[3] = 2.0;
  x[11] = 0.5;
  x[24] = 7.0;
  const SparseWeights found = nonnegative_least_squares(a, a * x, 1e-10, 25);
  Eigen::VectorXd again = Eigen::VectorXd::Zero(25);
  for (std::size_t i = 0; i < found.columns.size(); ++i)
    again[found.columns[i]] = found.weights[static_cast<Eigen::Index>(i)];
  EXPECT_LT((again - x).norm(), 1e-8);
  EXPECT_LE(found.left, 1e-10);
}

// Where no weights reach the sum, the gradient is zero at positive weights and not positive elsewhere (Karush, Kuhn,
// Tucker).
TEST(NonnegativeLeastSquares, EndsAtTheLeastResidual) {
  for (unsigned seed = 2; seed < 8; ++seed) {
    const Eigen::MatrixXd a = drawn(30, 60, seed).cwiseAbs();
    const Eigen::VectorXd b = drawn(30, 1, seed + 100).col(0);
    const SparseWeights found = nonnegative_least_squares(a, b, 0.0, 60);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(60);
    for (std::size_t i = 0; i < found.columns.size(); ++i)
      x[found.columns[i]] = found.weights[static_cast<Eigen::Index>(i)];
    EXPECT_GE(x.minCoeff(), 0.0);
    const Eigen::VectorXd residual = b - a * x, slope = a.transpose() * residual;
    EXPECT_NEAR(found.left, residual.norm() / b.norm(), 1e-9);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      EXPECT_LT(slope[i], 1e-8) << i;
      EXPECT_NEAR(x[i] * slope[i], 0.0, 1e-8) << i;
    }
  }
}

TEST(NonnegativeLeastSquares, StopsAtTheToleranceAndAtTheMostColumns) {
  const Eigen::MatrixXd a = drawn(200, 500, 9).cwiseAbs();
  const Eigen::VectorXd b = a.rowwise().sum();
  const SparseWeights rough = nonnegative_least_squares(a, b, 0.05, 500), few = nonnegative_least_squares(a, b, 0.0, 5);
  EXPECT_LE(rough.left, 0.05);
  EXPECT_LT(rough.columns.size(), 100u);
  EXPECT_EQ(few.columns.size(), 5u);
  EXPECT_GT(few.left, rough.left);
}

TEST(NonnegativeLeastSquares, LeavesASumOfNothingToNoColumn) {
  EXPECT_TRUE(nonnegative_least_squares(drawn(4, 3, 1), Eigen::VectorXd::Zero(4), 1e-6, 3).columns.empty());
}

}  // namespace
}  // namespace tissue_stiffness
