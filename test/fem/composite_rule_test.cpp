// Rules over a triangle: what they integrate exactly, whole and in parts.
#include "fem/facet_quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tissue_stiffness {
namespace {

// The corners are (0, 0), (1, 0), (0, 1), so a point's place is its coordinates. int x^a y^b = a! b! / (a + b + 2)!.
double integral(int nodes, int divisions, int a, int b) {
  FacetNodes x(3, nodes);
  x.leftCols(3) << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  if (nodes == 6) x.rightCols(3) << 0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0;
  const FacetQuadrature rule(nodes, divisions);
  double sum = 0.0;
  for (int q = 0; q < rule.points(); ++q) {
    const Eigen::Vector3d at = x * rule.shape(q);
    EXPECT_NEAR(rule.normal(x, q).norm(), 1.0, 1e-12);
    sum += rule.weight(q) * std::pow(at.x(), a) * std::pow(at.y(), b);
  }
  return sum;
}

TEST(CompositeRule, IsExactToItsDegreeWholeAndInParts) {
  for (const int divisions : {1, 2, 3, 5}) {
    for (const int nodes : {3, 6}) {
      EXPECT_NEAR(integral(nodes, divisions, 0, 0), 0.5, 1e-12);
      EXPECT_NEAR(integral(nodes, divisions, 1, 1), 1.0 / 24.0, 1e-12);
      EXPECT_NEAR(integral(nodes, divisions, 2, 0), 1.0 / 12.0, 1e-12);
    }
    EXPECT_NEAR(integral(6, divisions, 3, 1), 1.0 / 120.0, 1e-12);
  }
}

// A function with a kink: the error of n parts goes down with n.
TEST(CompositeRule, PartsResolveAKink) {
  const auto error = [](int divisions) {
    const FacetQuadrature rule(6, divisions);
    FacetNodes x(3, 6);
    x << 0, 1, 0, 0.5, 0.5, 0, 0, 0, 1, 0, 0.5, 0.5, 0, 0, 0, 0, 0, 0;
    double sum = 0.0;
    for (int q = 0; q < rule.points(); ++q) sum += rule.weight(q) * std::max(0.0, (x * rule.shape(q)).x() - 0.7);
    return std::abs(sum - std::pow(0.3, 3) / 6.0);
  };
  EXPECT_LT(error(4), 0.2 * error(1));
  EXPECT_EQ(FacetQuadrature(6, 4).points(), 96);
}

}  // namespace
}  // namespace tissue_stiffness
