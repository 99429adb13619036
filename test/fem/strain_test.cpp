// Strains of fields whose strain is known, and stiffness from strains against the one from gradients.
#include "fem/strain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "verification/elastic_body.hpp"

namespace tissue_stiffness {
namespace {

class StrainTest : public ::testing::TestWithParam<int> {
 protected:
  // The displacement u = H x of every node.
  Eigen::VectorXd linear(const Eigen::Matrix3d& h) const {
    return nodal(mesh_, [&h](const Eigen::Vector3d& x) -> Eigen::Vector3d { return h * x; });
  }
  // Whether all points of a field have this strain.
  ::testing::AssertionResult uniform(const Eigen::VectorXd& strains, const Strain& expected) const {
    for (Eigen::Index at = 0; at < strains.size(); at += 6) {
      const double off = (strains.segment<6>(at) - expected).norm();
      if (off > 1e-12) return ::testing::AssertionFailure() << "off by " << off << " at point " << at / 6;
    }
    return ::testing::AssertionSuccess();
  }
  static Eigen::Matrix3d some_gradient() { return (Eigen::Matrix3d() << 1, 2, 3, -4, 5, 6, 7, 8, -9).finished() * 0.01; }
  // The factor of every element is different, and one in three has none.
  static StrainFactor factor(int e) {
    if (e % 3 == 0) return StrainFactor(6, 0);
    return (1.0 + 0.1 * e) * isotropic_factor(2.0, 3.0);
  }

  const TetMesh mesh_ = distorted_box({0.03, 0.02, 0.01}, 2, GetParam());
  const Discretisation fem_{mesh_};
};

TEST_P(StrainTest, OfALinearFieldIsItsSymmetricPart) {
  const Eigen::Matrix3d h = some_gradient();
  const Strain expected = to_strain(0.5 * (h + h.transpose()));
  const double root = std::sqrt(2.0);
  EXPECT_NEAR(expected[0], 0.01, 1e-15);
  EXPECT_NEAR(expected[3], root * -0.01, 1e-15);
  EXPECT_NEAR(expected[4], root * 0.07, 1e-15);
  EXPECT_NEAR(expected[5], root * 0.05, 1e-15);
  EXPECT_TRUE(to_tensor(expected).isApprox(0.5 * (h + h.transpose()), 1e-14));
  Eigen::MatrixXd fields(fem_.dof_count(), 2);
  fields << linear(h), linear(-2.0 * h);
  const StrainRows found = strains(fem_, fields);
  ASSERT_EQ(found.rows(), strain_count(fem_));
  EXPECT_TRUE(uniform(found.col(0), expected));
  EXPECT_TRUE(uniform(found.col(1), -2.0 * expected));
  EXPECT_LT((strain_at(fem_, fields.col(0), 3, fem_.points_per_element() - 1) - expected).norm(), 1e-12);
}

TEST_P(StrainTest, OfGreenIsZeroForARotation) {
  const Eigen::Matrix3d r = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Eigen::VectorXd found(strain_count(fem_));
  green_strains(fem_, linear(r - Eigen::Matrix3d::Identity()), found);
  EXPECT_TRUE(uniform(found, Strain::Zero()));
  const Eigen::Matrix3d f = r * (Eigen::Matrix3d::Identity() + some_gradient());
  green_strains(fem_, linear(f - Eigen::Matrix3d::Identity()), found);
  EXPECT_TRUE(uniform(found, to_strain(0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity()))));
}

TEST_P(StrainTest, ChangesAtGreensRate) {
  constexpr double kStep = 1e-6;
  const Eigen::VectorXd u = random_vector(fem_.dof_count(), 1e-3, 1), v = random_vector(fem_.dof_count(), 1e-3, 2);
  Eigen::VectorXd rate(strain_count(fem_)), before = rate, after = rate;
  green_strain_rates(fem_, u, v, rate);
  green_strains(fem_, u - kStep * v, before);
  green_strains(fem_, u + kStep * v, after);
  EXPECT_LT((rate - (after - before) / (2.0 * kStep)).norm(), 1e-8 * rate.norm());
}

TEST_P(StrainTest, FactorsGiveHookesLaw) {
  const Eigen::Vector3d d(0.6, 0.0, 0.8);
  EXPECT_TRUE(to_tensor(strain_of(d)).isApprox(d * d.transpose(), 1e-14));
  const double lambda = 5.0, mu = 3.0;
  const StrainFactor r = isotropic_factor(lambda, mu);
  const Strain strain = to_strain(some_gradient()), m = to_strain(Eigen::Matrix3d::Identity());
  EXPECT_TRUE((r * (r.transpose() * strain)).isApprox(lambda * m.dot(strain) * m + 2.0 * mu * strain, 1e-14));
}

TEST_P(StrainTest, GivesTheStiffnessOfAnIsotropicBody) {
  const SparseMatrix expected = linear_stiffness(fem_, {4.0, 6.0});
  SparseMatrix found = fem_.pattern();
  add_strain_stiffness(
      fem_, [](int, int) { return isotropic_factor(2.0, 3.0); }, 2.0, found);
  EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
}

TEST_P(StrainTest, AppliesAndProjectsTheStiffnessThatItAssembles) {
  const auto field = [](int e, int) { return factor(e); };
  SparseMatrix k = fem_.pattern();
  add_strain_stiffness(fem_, field, 1.0, k);
  Eigen::MatrixXd u(fem_.dof_count(), 3);
  for (int c = 0; c < 3; ++c) u.col(c) = random_vector(fem_.dof_count(), 1.0, static_cast<unsigned>(c));
  const StrainRows rows = strains(fem_, u);
  const Eigen::MatrixXd expected = k * u, projected = u.transpose() * expected;
  EXPECT_LT((apply_strain_stiffness(fem_, field, rows) - expected).norm(), 1e-12 * expected.norm());
  EXPECT_LT((project_strain_stiffness(fem_, field, rows) - projected).norm(), 1e-12 * projected.norm());
  Eigen::VectorXd force = Eigen::VectorXd::Ones(fem_.dof_count());
  const int points = fem_.points_per_element();
  const auto stress = [&](int e, int q) -> Strain {
    const StrainFactor r = factor(e);
    return r * (r.transpose() * Strain(rows.block<6, 1>(6 * (static_cast<Eigen::Index>(e) * points + q), 1)));
  };
  add_stress_force(fem_, stress, force);
  EXPECT_LT((Eigen::VectorXd::Ones(fem_.dof_count()) - expected.col(1) - force).norm(), 1e-12 * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(Orders, StrainTest, ::testing::Values(1, 2));

}  // namespace
}  // namespace tissue_stiffness
