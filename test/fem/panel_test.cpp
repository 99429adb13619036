// Every instruction set's kernels against plain loops.
#include "fem/panel.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>

namespace tissue_stiffness {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class Kernels : public testing::Test {
 protected:
  template <typename Matrix>
  Matrix random(Eigen::Index rows, Eigen::Index columns) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return Matrix::NullaryExpr(rows, columns, [&] { return static_cast<typename Matrix::Scalar>(uniform(engine_)); });
  }
  /// Of every instruction set's kernels, heights and widths of a panel.
  template <typename Check>
  void for_every_panel(const Check& check) {
    for (const PanelKernels& kernels : panel_kernels()) {
      for (const int rows : {0, 3, 16, 83}) {
        for (int columns = 1; columns <= kPanelColumns; ++columns) check(kernels, rows, columns);
      }
    }
  }
  static constexpr int kStride = 90;
  std::mt19937 engine_{1};
};

TEST_F(Kernels, BeginWithTheFastestAndEndWithOneForAnyMachine) {
  ASSERT_FALSE(panel_kernels().empty());
  EXPECT_STREQ(panel_kernels().back().instructions, "any");
}

TEST_F(Kernels, SubtractAPanel) {
  for_every_panel([this](const PanelKernels& kernels, int rows, int columns) {
    const auto panel = random<Eigen::MatrixXf>(kStride, kPanelWidth), c = random<Eigen::MatrixXf>(kPanelWidth, columns);
    auto t = random<Eigen::MatrixXf>(kStride, columns);
    Eigen::MatrixXf expected = t;
    expected.topRows(rows) -= panel.topRows(rows) * c;
    kernels.panel_subtract(rows, panel.data(), kStride, c.data(), columns, t.data(), kStride);
    EXPECT_LT((t - expected).cwiseAbs().maxCoeff(), 1e-6F) << kernels.instructions << ' ' << rows << ' ' << columns;
  });
}

TEST_F(Kernels, MultiplyByATransposedPanel) {
  for_every_panel([this](const PanelKernels& kernels, int rows, int columns) {
    const auto panel = random<Eigen::MatrixXf>(kStride, kPanelWidth), t = random<Eigen::MatrixXf>(kStride, columns);
    Eigen::MatrixXf sums = Eigen::MatrixXf::Constant(kPanelWidth, kPanelColumns, 7.0F);
    kernels.panel_dot(rows, panel.data(), kStride, t.data(), kStride, columns, sums.data());
    const Eigen::MatrixXf expected = panel.topRows(rows).transpose() * t.topRows(rows);
    EXPECT_LT((sums.leftCols(columns) - expected).cwiseAbs().maxCoeff(), 1e-5F) << kernels.instructions << ' ' << rows;
    EXPECT_TRUE((sums.rightCols(kPanelColumns - columns).array() == 7.0F).all()) << "no column beyond";
  });
}

TEST_F(Kernels, MultiplyTiles) {
  for (const PanelKernels& kernels : panel_kernels()) {
    for (const int rows : {0, 1, 57}) {
      const auto a = random<RowMajor>(rows, kTileHeight), b = random<RowMajor>(rows, kRowWidth);
      RowMajor c = RowMajor::Constant(kTileHeight, kRowWidth, 7.0);
      kernels.tile_product(rows, a.data(), b.data(), c.data());
      EXPECT_LT((c - a.transpose() * b).cwiseAbs().maxCoeff(), 1e-13) << kernels.instructions << ' ' << rows;
    }
  }
}

TEST_F(Kernels, SumRows) {
  const std::vector<int> rows{3, 0, 19, 4, 4};
  for (const PanelKernels& kernels : panel_kernels()) {
    for (int columns = kRowWidth; columns <= 20 * kRowWidth; columns += kRowWidth) {
      const auto x = random<RowMajor>(20, columns);
      const auto values = random<Eigen::VectorXd>(5, 1);
      Eigen::RowVectorXd expected = Eigen::RowVectorXd::Zero(columns), y = expected;
      for (Eigen::Index k = 0; k < 5; ++k) expected += values[k] * x.row(rows[static_cast<std::size_t>(k)]);
      kernels.sum_rows(5, values.data(), rows.data(), x.data(), columns, y.data());
      EXPECT_LT((y - expected).cwiseAbs().maxCoeff(), 1e-14) << kernels.instructions << ' ' << columns;
    }
  }
}

TEST_F(Kernels, SumBlocks) {
  using Single = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const std::vector<int> nodes{3, 0, 6, 4, 4};
  for (const PanelKernels& kernels : panel_kernels()) {
    for (int columns = kFloatWidth; columns <= 10 * kFloatWidth; columns += kFloatWidth) {
      const auto x = random<Single>(21, columns), blocks = random<Single>(15, 3);
      Single expected = Single::Zero(3, columns), y = expected;
      for (Eigen::Index k = 0; k < 5; ++k) {
        expected += blocks.middleRows<3>(3 * k) * x.middleRows<3>(3 * nodes[static_cast<std::size_t>(k)]);
      }
      kernels.sum_blocks(5, blocks.data(), nodes.data(), x.data(), columns, y.data());
      EXPECT_LT((y - expected).cwiseAbs().maxCoeff(), 1e-5F) << kernels.instructions << ' ' << columns;
    }
  }
}

}  // namespace
}  // namespace tissue_stiffness
