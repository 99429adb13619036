// The factor in single precision against the one in double.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <vector>

#include "fem/sparse_solver.hpp"
#include "verification/elastic_body.hpp"

namespace tissue_stiffness {
namespace {

SparseMatrix held_stiffness(int cells) {
  const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 3 * cells, cells, cells, 2);
  const ElasticBody body(mesh, ElasticBody::Law::linear, lame(30e3, 0.45), 1000.0, clamped_dofs(mesh));
  SparseMatrix k = linear_stiffness(body.fem(), lame(30e3, 0.45)) + 1e4 * body.mass();
  fix_dofs(k, body.fixed(), k.diagonal().mean());
  return k;
}

// From one supernode and no subtrees to a tree cut into a dozen; more columns than a panel takes at once.
TEST(SingleFactor, SolvesToSixDigits) {
  for (const int cells : {1, 2, 4}) {
    const SparseMatrix k = held_stiffness(cells);
    SparseSolver solver;
    solver.factorize(k);
    for (const int columns : {1, 2, 3, 4, 7}) {
      Eigen::MatrixXd b(k.rows(), columns);
      for (int c = 0; c < columns; ++c)
        b.col(c) = random_vector(k.rows(), std::pow(10.0, 8 * c - 20), 5U + static_cast<unsigned>(c));
      const Eigen::MatrixXd exact = solver.solve(b), rough = solver.solve_roughly(b);
      for (int c = 0; c < columns; ++c) {
        EXPECT_LT((rough.col(c) - exact.col(c)).norm(), 1e-4 * exact.col(c).norm()) << cells << " cells, column " << c;
        EXPECT_EQ(rough.col(c), solver.solve_roughly(b.middleCols(0, columns)).col(c)) << "not the same twice";
      }
      solver.solve_roughly_in_place(b);
      EXPECT_EQ(b, rough) << cells << " cells, in place";
    }
  }
}

// CHOLMOD would choose a factor of another layout for so few unknowns.
TEST(SingleFactor, SolvesAFewUnknowns) {
  for (const int size : {1, 3, 12}) {
    SparseMatrix k(size, size);
    for (int i = 0; i < size; ++i) k.insert(i, i) = 2.0 + i;
    for (int i = 0; i + 1 < size; ++i) k.insert(i + 1, i) = k.insert(i, i + 1) = -1.0;
    k.makeCompressed();
    SparseSolver solver;
    solver.factorize(k);
    const Eigen::VectorXd x = random_vector(size, 1.0, 3), b = k * x;
    EXPECT_LT((solver.solve(b) - x).norm(), 1e-12);
    EXPECT_LT((solver.solve_roughly(b) - x).norm(), 1e-5);
  }
}

TEST(SingleFactor, LeavesZeroAlone) {
  const SparseMatrix k = held_stiffness(2);
  SparseSolver solver;
  solver.factorize(k);
  EXPECT_TRUE(solver.solve_roughly(Eigen::MatrixXd::Zero(k.rows(), 2)).isZero(0.0));
}

// Threads of BLAS are a setting of the whole process: nobody may change it while others work.
TEST(SparseSolver, GivesTheSameBytesWhateverWorksBesideIt) {
  const SparseMatrix k = held_stiffness(4);
  const Eigen::MatrixXd b = random_vector(k.rows(), 1.0, 9);
  const auto solution = [&](const SparseSolver& solver) { return solver.solve(b); };
  SparseSolver alone;
  alone.factorize(k);
  const Eigen::MatrixXd expected = solution(alone);
  std::vector<Eigen::MatrixXd> found(8);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
    SparseSolver own;
    if (i % 2 == 0) own.factorize(k);
    found[i] = solution(i % 2 == 0 ? own : alone);
  });
  for (const Eigen::MatrixXd& x : found) EXPECT_EQ(x, expected);
}

}  // namespace
}  // namespace tissue_stiffness
