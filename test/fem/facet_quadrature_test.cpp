// Integrals over the surface of a box.
#include "fem/facet_quadrature.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "verification/elastic_body.hpp"

namespace tissue_stiffness {
namespace {

const Eigen::Vector3d kSize(0.03, 0.02, 0.01);

class FacetTest : public ::testing::TestWithParam<int> {
 protected:
  std::vector<int> all() const {
    std::vector<int> out(static_cast<std::size_t>(mesh_.facets.cols()));
    std::iota(out.begin(), out.end(), 0);
    return out;
  }
  // Facets whose nodes all have z = 0.01.
  std::vector<int> top() const {
    std::vector<int> out;
    for (const int f : all()) {
      if (facet_nodes(mesh_, f).row(2).minCoeff() > kSize.z() - 1e-9) out.push_back(f);
    }
    return out;
  }
  double area() const { return 2.0 * (kSize.x() * kSize.y() + kSize.y() * kSize.z() + kSize.z() * kSize.x()); }
  Eigen::VectorXd field(const std::function<double(const Eigen::Vector3d&)>& value) const {
    return nodal(mesh_, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return {0.0, value(x), 0.0}; });
  }

  const TetMesh mesh_ = distorted_box(kSize, 2, GetParam());
  const FacetQuadrature rule_{static_cast<int>(mesh_.facets.rows())};
};

TEST_P(FacetTest, NormalsSumToNothingAndTheirLengthsToTheArea) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), outwards = Eigen::Vector3d::Zero();
  double found = 0.0, half = 0.0;
  for (int q = 0; q < rule_.points(); ++q) half += rule_.weight(q);
  EXPECT_NEAR(half, 0.5, 1e-14);
  for (const int f : all()) {
    for (int q = 0; q < rule_.points(); ++q) {
      const Eigen::Vector3d n = rule_.weight(q) * rule_.normal(facet_nodes(mesh_, f), q);
      sum += n;
      found += n.norm();
      outwards += n.cwiseProduct(facet_nodes(mesh_, f) * rule_.shape(q));
    }
  }
  EXPECT_LT(sum.norm(), 1e-14 * area());
  EXPECT_NEAR(found, area(), 1e-12 * area());
  EXPECT_TRUE(outwards.isApprox(Eigen::Vector3d::Constant(kSize.prod()), 1e-12)) << "Gauss's theorem";
}

TEST_P(FacetTest, NodesMoveWithTheDisplacement) {
  const Eigen::VectorXd u = random_vector(3 * mesh_.node_count(), 1e-3, 1);
  for (const int f : {0, 5}) {
    const FacetNodes rest = facet_nodes(mesh_, f), moved = facet_nodes(mesh_, f, &u);
    for (Eigen::Index a = 0; a < rest.cols(); ++a) {
      EXPECT_TRUE(moved.col(a).isApprox(rest.col(a) + u.segment<3>(3 * mesh_.facets(a, f)), 1e-14));
    }
    const std::vector<int> local = facet_local_nodes(mesh_, f);
    for (std::size_t a = 0; a < local.size(); ++a) {
      EXPECT_EQ(mesh_.tets(local[a], mesh_.facet_tet[f]), mesh_.facets(static_cast<Eigen::Index>(a), f));
    }
  }
}

TEST_P(FacetTest, MassIntegratesProductsOfFields) {
  const SparseMatrix mass = facet_mass(mesh_, top());
  const Eigen::VectorXd one = field([](const Eigen::Vector3d&) { return 1.0; }),
                        x = field([](const Eigen::Vector3d&p) { return p.x(); });
  const double expected = kSize.x() * kSize.y();
  EXPECT_NEAR(one.dot(mass * one), expected, 1e-12 * expected);
  EXPECT_NEAR(one.dot(mass * x), 0.5 * kSize.x() * expected, 1e-12 * expected);
  EXPECT_NEAR(x.dot(mass * x), kSize.x() * kSize.x() / 3.0 * expected, 1e-12 * kSize.x() * expected);
  EXPECT_EQ(mass.rows(), 3 * mesh_.node_count());
}

TEST_P(FacetTest, MeanOfAFieldIsThatOverTheArea) {
  const Eigen::VectorXd weights = facet_mean(mesh_, top());
  EXPECT_NEAR(weights.sum(), 1.0, 1e-14);
  EXPECT_NEAR(weights.dot(mesh_.nodes.row(0)), 0.5 * kSize.x(), 1e-14);
  EXPECT_NEAR(weights.dot(mesh_.nodes.row(2)), kSize.z(), 1e-14);
  const Eigen::VectorXd force = along_axis(weights, 1);
  EXPECT_TRUE(resultant(force).isApprox(Eigen::Vector3d::UnitY(), 1e-14));
  EXPECT_EQ(force[3 * mesh_.facets(0, top().front()) + 1], weights[mesh_.facets(0, top().front())]);
}

INSTANTIATE_TEST_SUITE_P(Orders, FacetTest, ::testing::Values(1, 2));

}  // namespace
}  // namespace tissue_stiffness
