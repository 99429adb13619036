#include "fem/products.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "fem/panel.hpp"

namespace tissue_stiffness {
namespace {

constexpr Eigen::Index kBlock = 512;     // rows that are packed at once
constexpr Eigen::Index kShare = 8192;    // rows of one summand
constexpr Eigen::Index kGrain = 512;     // rows of a sparse product that are worth a task
constexpr Eigen::Index kTask = 1 << 18;  // values of a packed matrix that are

Eigen::Index panels(Eigen::Index columns, int width) {
  return (columns + width - 1) / width;
}

// Packs panels of `width` columns, each row by row. Missing columns are zero.
template <typename Matrix>
void pack(const Matrix& a, int width, std::vector<double>& out) {
  const Eigen::Index rows = a.rows(), count = panels(a.cols(), width);
  out.assign(static_cast<std::size_t>(count * rows * width), 0.0);
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    double* to = out.data() + (j / width) * rows * width + j % width;
    for (Eigen::Index r = 0; r < rows; ++r) to[r * width] = a(r, j);
  }
}

// Returns row j of a symmetric matrix times x.
template <typename Vector>
double row_product(const SparseMatrix& s, Eigen::Index j, const Vector& x) {
  double sum = 0.0;
  for (SparseMatrix::InnerIterator entry(s, j); entry; ++entry) sum += entry.value() * x[entry.row()];
  return sum;
}

struct Packed {
  std::vector<double> left, right;
};

// Multiplies one panel, `depth` x kTileHeight, by the columns before `end` that are packed in `right`. It calls take(row,
// column, value) for the panel's first `height` rows.
template <typename Take>
void multiply_panel(const double* panel, const std::vector<double>& right, Eigen::Index depth, Eigen::Index height,
                    Eigen::Index end, const Take& take) {
  double tile[kTileHeight * kRowWidth];
  for (Eigen::Index left = 0; left < end; left += kRowWidth) {
    const Eigen::Index width = std::min<Eigen::Index>(kRowWidth, end - left);
    tile_product(depth, panel, right.data() + left * depth, tile);
    for (Eigen::Index c = 0; c < width; ++c) {
      for (Eigen::Index r = 0; r < height; ++r) take(r, left + c, tile[kRowWidth * r + c]);
    }
  }
}

// Computes sum += left^T right. With `lower` only the columns up to the diagonal of each panel's rows are computed.
void add_tiles(const Packed& packed, Eigen::Index rows, bool lower, Eigen::MatrixXd& sum) {
  for (Eigen::Index top = 0; top < sum.rows(); top += kTileHeight) {
    const Eigen::Index height = std::min<Eigen::Index>(kTileHeight, sum.rows() - top);
    multiply_panel(packed.left.data() + top * rows, packed.right, rows, height, lower ? top + height : sum.cols(),
                   [&](Eigen::Index r, Eigen::Index c, double value) { sum(top + r, c) += value; });
  }
}

}  // namespace

Eigen::MatrixXd symmetric_product(const SparseMatrix& s, const Eigen::MatrixXd& x) {
  const Eigen::Index n = x.rows(), columns = kRowWidth * panels(x.cols(), kRowWidth);
  if (x.cols() < kRowWidth / 2) {  // padded it would be more work
    Eigen::MatrixXd out(n, x.cols());
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, n, kGrain), [&](const auto& part) {
      for (Eigen::Index c = 0; c < x.cols(); ++c) {
        for (Eigen::Index j = part.begin(); j < part.end(); ++j) out(j, c) = row_product(s, j, x.col(c));
      }
    });
    return out;
  }
  GramSum::Rows from = GramSum::Rows::Zero(n, columns), to(n, columns);
  from.leftCols(x.cols()) = x;
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, n, kGrain), [&](const auto& part) {
    for (Eigen::Index j = part.begin(); j < part.end(); ++j) {
      const int begin = s.outerIndexPtr()[j], end = s.outerIndexPtr()[j + 1];
      sum_rows(end - begin, s.valuePtr() + begin, s.innerIndexPtr() + begin, from.data(), columns, to.row(j).data());
    }
  });
  return to.leftCols(x.cols());
}

void subtract_product(const SparseMatrix& s, const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::VectorXd& y) {
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, s.outerSize(), kGrain), [&](const auto& part) {
    for (Eigen::Index j = part.begin(); j < part.end(); ++j) y[j] -= row_product(s, j, x);
  });
}

Eigen::MatrixXd inner_products(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& b) {
  const Eigen::Index n = a.rows(), shares = panels(n, kShare);
  std::vector<Eigen::MatrixXd> sums(static_cast<std::size_t>(shares), Eigen::MatrixXd::Zero(a.cols(), b.cols()));
  tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t share) {
    Packed packed;
    const Eigen::Index begin = kShare * static_cast<Eigen::Index>(share), end = std::min(n, begin + kShare);
    for (Eigen::Index at = begin; at < end; at += kBlock) {
      const Eigen::Index rows = std::min(kBlock, end - at);
      pack(a.middleRows(at, rows), kTileHeight, packed.left);
      pack(b.middleRows(at, rows), kRowWidth, packed.right);
      add_tiles(packed, rows, false, sums[share]);
    }
  });
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  for (const Eigen::MatrixXd& sum : sums) out += sum;
  return out;
}

void GramSum::add(const Rows& a, Eigen::Index count) {
  Packed packed;
  for (Eigen::Index at = 0; at < count; at += kBlock) {
    const Eigen::Index rows = std::min(kBlock, count - at);
    pack(a.middleRows(at, rows), kTileHeight, packed.left);
    pack(a.middleRows(at, rows), kRowWidth, packed.right);
    add_tiles(packed, rows, true, sum_);
  }
  sum_.triangularView<Eigen::StrictlyUpper>() = sum_.transpose();
}

PackedMatrix::PackedMatrix(const Eigen::Ref<const Eigen::MatrixXd>& a) : rows_(a.rows()), columns_(a.cols()) {
  pack(a.transpose(), kTileHeight, panels_);
}

void PackedMatrix::multiply(const Eigen::MatrixXd& x, Eigen::Ref<Eigen::MatrixXd> out) const {
  std::vector<double> right;
  pack(x, kRowWidth, right);
  const Eigen::Index panel = kTileHeight * columns_;
  const Eigen::Index grain = std::max<Eigen::Index>(1, kTask / std::max<Eigen::Index>(1, panel));
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, panels(rows_, kTileHeight), grain), [&](const auto& part) {
    for (Eigen::Index i = part.begin(); i < part.end(); ++i) {
      const Eigen::Index top = i * kTileHeight, height = std::min<Eigen::Index>(kTileHeight, rows_ - top);
      multiply_panel(panels_.data() + i * panel, right, columns_, height, x.cols(),
                     [&](Eigen::Index r, Eigen::Index c, double value) { out(top + r, c) = value; });
    }
  });
}

Eigen::MatrixXd PackedMatrix::operator*(const Eigen::MatrixXd& x) const {
  Eigen::MatrixXd out(rows_, x.cols());
  multiply(x, out);
  return out;
}

}  // namespace tissue_stiffness
