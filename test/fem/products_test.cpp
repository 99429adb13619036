// Products of tall matrices against Eigen's.
#include "fem/products.hpp"

#include <gtest/gtest.h>

#include "verification/elastic_body.hpp"

namespace tissue_stiffness {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  const Eigen::VectorXd values = random_vector(rows * columns, 1.0, seed);
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), rows, columns);
}

// From one column to more than a vector, a tile and four vectors hold.
TEST(Products, SymmetricTimesTall) {
  const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 6, 2, 2, 2);
  const SparseMatrix k = linear_stiffness(Discretisation(mesh), lame(30e3, 0.45));
  for (const Eigen::Index columns : {1, 3, 4, 8, 33, 50}) {
    const Eigen::MatrixXd x = random_matrix(k.rows(), columns, 3), expected = k * x;
    EXPECT_LT((symmetric_product(k, x) - expected).norm(), 1e-13 * expected.norm()) << columns << " columns";
  }
}

// Fewer rows than a block, a block's remainder, more than one summand.
TEST(Products, InnerProducts) {
  for (const Eigen::Index rows : {5, 700, 20000}) {
    for (const Eigen::Index columns : {1, 6, 8, 13}) {
      const Eigen::MatrixXd a = random_matrix(rows, columns, 1), b = random_matrix(rows, 2 * columns + 1, 2);
      const Eigen::MatrixXd expected = a.transpose() * b;
      EXPECT_LT((inner_products(a, b) - expected).norm(), 1e-13 * a.norm() * b.norm()) << rows << " x " << columns;
    }
  }
}

TEST(Products, OfAPackedMatrix) {
  for (const Eigen::Index rows : {1, 7, 1500}) {
    for (const Eigen::Index columns : {1, 8, 13}) {
      const Eigen::MatrixXd a = random_matrix(rows, 40, 1), x = random_matrix(40, columns, 2);
      const PackedMatrix packed(a), transposed(a.transpose());
      EXPECT_EQ(packed.rows(), rows);
      EXPECT_LT((packed * x - a * x).norm(), 1e-13 * a.norm() * x.norm()) << rows << " x " << columns;
      const Eigen::MatrixXd b = random_matrix(rows, columns, 3);
      EXPECT_LT((transposed * b - a.transpose() * b).norm(), 1e-13 * a.norm() * b.norm()) << rows << " x " << columns;
    }
  }
}

TEST(Products, SumOfGramMatrices) {
  for (const Eigen::Index columns : {1, 6, 8, 19}) {
    const GramSum::Rows a = random_matrix(1100, columns, 4), b = random_matrix(40, columns, 5);
    GramSum gram(columns);
    gram.add(a, 1030);
    gram.add(b, 40);
    const Eigen::MatrixXd expected = a.topRows(1030).transpose() * a.topRows(1030) + b.transpose() * b;
    EXPECT_LT((gram.sum() - expected).norm(), 1e-13 * expected.norm()) << columns << " columns";
    EXPECT_EQ(gram.sum(), gram.sum().transpose());
  }
}

}  // namespace
}  // namespace tissue_stiffness
