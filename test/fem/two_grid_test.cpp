// Solutions between two meshes against those by a factor.
#include "fem/two_grid.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

#include "meshing/refine.hpp"
#include "verification/elastic_body.hpp"

namespace tissue_stiffness {
namespace {

const Eigen::Vector3d kSize(0.10, 0.08, 0.06);

struct Body {
  TetMesh coarse, fine;
  std::vector<char> fixed;
  SparseMatrix stiffness;

  Body(int order, double poisson_ratio, double held_to = 0.0)
      : coarse(distorted_box(kSize, 3, order)), fine(refine_mesh(coarse)), fixed(clamped_dofs(fine)) {
    for (int i = 0; i < fine.node_count(); ++i) {
      if (fine.nodes(0, i) < held_to) std::fill_n(fixed.begin() + 3 * i, 3, char{1});
    }
    stiffness = linear_stiffness(Discretisation(fine), lame(20e3, poisson_ratio));
    fix_dofs(stiffness, fixed, stiffness.diagonal().mean());
  }

  TwoGrid between() const { return {SparseMatrix(stiffness), fixed, prolongation(coarse, fine)}; }

  // Smooth, rough, and none at all.
  Eigen::MatrixXd loads() const {
    Eigen::MatrixXd out(stiffness.rows(), 30);
    for (int j = 0; j < out.cols(); ++j) {
      out.col(j) = j < 4 ? nodal(fine,
                                 [j](const auto& x) -> Eigen::Vector3d {
                                   return {0.0, 1.0, std::sin(30.0 * j * x.x())};
                                 })
                         : random_vector(out.rows(), 1.0, static_cast<unsigned>(j));
    }
    out.col(7).setZero();
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      if (fixed[static_cast<std::size_t>(i)] != 0) out.row(i).setZero();
    }
    return out;
  }
};

// In the energy norm, of each column.
double worst(const SparseMatrix& k, const Eigen::MatrixXd& found, const Eigen::MatrixXd& wanted) {
  const Eigen::MatrixXd error = found - wanted;
  const auto energy = [&k](const Eigen::MatrixXd& x) {
    return Eigen::ArrayXd((x.array() * (k * x).array()).colwise().sum().transpose());
  };
  const Eigen::ArrayXd of_error = energy(error), of_wanted = energy(wanted);
  return std::sqrt((of_wanted > 0.0).select(of_error / of_wanted, of_error).maxCoeff());
}

// Also where a support holds nearly all that some nodes of the coarse mesh move.
TEST(TwoGrid, SolvesAsAFactorDoes) {
  for (const auto& [order, held_to] : {std::pair{1, 0.0}, {2, 0.0}, {1, 0.06}, {2, 0.06}}) {
    const Body body(order, 0.45, held_to);
    const Eigen::MatrixXd loads = body.loads();
    SparseSolver factor;
    factor.factorize(body.stiffness);
    const auto found = body.between().solve(loads);
    ASSERT_TRUE(found);
    const double off = worst(body.stiffness, *found, factor.solve(loads));
    std::printf("between two meshes, order %d, held to %.2f m: off by %.1e\n", order, held_to, off);
    EXPECT_LT(off, 0.04);
    for (Eigen::Index i = 0; i < found->rows(); ++i) {
      if (body.fixed[static_cast<std::size_t>(i)] == 0) continue;
      ASSERT_EQ(found->row(i).norm(), 0.0);
    }
  }
}

// Straight edges: the coarse mesh's functions are the fine one's, too.
TEST(TwoGrid, SeesTheCoarseMeshsOwnStiffness) {
  const Body body(2, 0.45);
  const std::vector<char> none(body.fixed.size(), 0);
  const SparseMatrix wanted = linear_stiffness(Discretisation(body.coarse), lame(20e3, 0.45));
  const SparseMatrix fine = linear_stiffness(Discretisation(body.fine), lame(20e3, 0.45));
  const TwoGrid free(SparseMatrix(fine + 1e-3 * body.stiffness), none, prolongation(body.coarse, body.fine));
  EXPECT_LT(Eigen::MatrixXd(free.to_coarse(fine) - wanted).norm(), 1e-9 * Eigen::MatrixXd(wanted).norm());
}

// Its residuals would not tell.
TEST(TwoGrid, SaysWhereAFactorIsFaster) {
  for (const double ratio : {0.49, 0.499, 0.49999}) {
    const Body body(2, ratio);
    EXPECT_FALSE(body.between().solve(body.loads())) << ratio;
  }
}

TEST(TwoGrid, DoesNotDependOnTheNumberOfCores) {
  const Body body(2, 0.45);
  const Eigen::MatrixXd loads = body.loads().leftCols(5);
  const auto many = body.between().solve(loads);
  tbb::task_arena one(1);
  const auto alone = one.execute([&] { return body.between().solve(loads); });
  ASSERT_TRUE(many && alone);
  EXPECT_EQ(*many, *alone);
}

}  // namespace
}  // namespace tissue_stiffness
