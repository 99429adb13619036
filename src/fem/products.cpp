// Products of tall matrices, their inner loops compiled for several instruction sets; the machine picks one at load time.
#include "tissue_stiffness/fem/products.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <vector>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define FOR_EVERY_MACHINE __attribute__((target_clones("avx512f", "arch=haswell", "default")))
#else
#define FOR_EVERY_MACHINE
#endif

namespace tissue_stiffness {
namespace {

constexpr int kLanes = 8;
constexpr int kTile = 6;               // of the left factor's columns: with a vector of the right's, what registers hold
constexpr Eigen::Index kBlock = 512;   // rows that are packed at once
constexpr Eigen::Index kShare = 8192;  // rows of one summand
typedef double Lanes __attribute__((vector_size(kLanes * sizeof(double)), aligned(sizeof(double)), may_alias));

Eigen::Index panels(Eigen::Index columns, int width) {
  return (columns + width - 1) / width;
}

// c (kTile x kLanes) = sum over rows of a (rows x kTile) times b (rows x kLanes), both packed.
FOR_EVERY_MACHINE void tile_product(Eigen::Index rows, const double* a, const double* b, double* c) {
  Lanes sum[kTile];
  std::memset(sum, 0, sizeof sum);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const Lanes right = *reinterpret_cast<const Lanes*>(b + kLanes * r);
    for (int i = 0; i < kTile; ++i) sum[i] += a[kTile * r + i] * right;
  }
  std::memcpy(c, sum, sizeof sum);
}

// y (columns, a multiple of kLanes) = sum over k of values[k] times row rows[k] of x.
FOR_EVERY_MACHINE void sum_rows(int count, const double* values, const int* rows, const double* x, Eigen::Index columns,
                                double* y) {
  constexpr int wide = 4;
  Eigen::Index at = 0;
  for (; at + wide * kLanes <= columns; at += wide * kLanes) {
    Lanes sum[wide];
    std::memset(sum, 0, sizeof sum);
    for (int k = 0; k < count; ++k) {
      const double* row = x + columns * rows[k] + at;
      for (int i = 0; i < wide; ++i) sum[i] += values[k] * *reinterpret_cast<const Lanes*>(row + kLanes * i);
    }
    std::memcpy(y + at, sum, sizeof sum);
  }
  for (; at < columns; at += kLanes) {
    Lanes sum;
    std::memset(&sum, 0, sizeof sum);
    for (int k = 0; k < count; ++k) sum += values[k] * *reinterpret_cast<const Lanes*>(x + columns * rows[k] + at);
    std::memcpy(y + at, &sum, sizeof sum);
  }
}

// Panels of `width` columns, row by row in each; columns that are missing are zero.
template <typename Matrix>
void pack(const Matrix& a, int width, std::vector<double>& out) {
  const Eigen::Index rows = a.rows(), count = panels(a.cols(), width);
  out.assign(static_cast<std::size_t>(count * rows * width), 0.0);
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    double* to = out.data() + (j / width) * rows * width + j % width;
    for (Eigen::Index r = 0; r < rows; ++r) to[r * width] = a(r, j);
  }
}

struct Packed {
  std::vector<double> left, right;
};

// sum += left^T right; `lower`: the tiles that touch the lower triangle only.
void add_tiles(const Packed& packed, Eigen::Index rows, bool lower, Eigen::MatrixXd& sum) {
  double tile[kTile * kLanes];
  for (Eigen::Index i = 0; i < panels(sum.rows(), kTile); ++i) {
    const Eigen::Index top = i * kTile, height = std::min<Eigen::Index>(kTile, sum.rows() - top);
    for (Eigen::Index j = 0; j < panels(sum.cols(), kLanes); ++j) {
      const Eigen::Index left = j * kLanes, width = std::min<Eigen::Index>(kLanes, sum.cols() - left);
      if (lower && left > top + height - 1) break;
      tile_product(rows, packed.left.data() + top * rows, packed.right.data() + left * rows, tile);
      for (Eigen::Index c = 0; c < width; ++c) {
        for (Eigen::Index r = 0; r < height; ++r) sum(top + r, left + c) += tile[kLanes * r + c];
      }
    }
  }
}

}  // namespace

Eigen::MatrixXd symmetric_product(const SparseMatrix& s, const Eigen::MatrixXd& x) {
  constexpr Eigen::Index grain = 512;
  const Eigen::Index n = x.rows(), columns = kLanes * panels(x.cols(), kLanes);
  if (x.cols() < kLanes / 2) {  // padded it would be more work
    Eigen::MatrixXd out(n, x.cols());
    tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, n, grain), [&](const auto& part) {
      for (Eigen::Index j = part.begin(); j < part.end(); ++j) {
        out.row(j).setZero();
        for (SparseMatrix::InnerIterator it(s, j); it; ++it) out.row(j) += it.value() * x.row(it.row());
      }
    });
    return out;
  }
  GramSum::Rows from = GramSum::Rows::Zero(n, columns), to(n, columns);
  from.leftCols(x.cols()) = x;
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, n, grain), [&](const auto& part) {
    for (Eigen::Index j = part.begin(); j < part.end(); ++j) {
      const int begin = s.outerIndexPtr()[j], end = s.outerIndexPtr()[j + 1];
      sum_rows(end - begin, s.valuePtr() + begin, s.innerIndexPtr() + begin, from.data(), columns, to.row(j).data());
    }
  });
  return to.leftCols(x.cols());
}

Eigen::MatrixXd inner_products(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& b) {
  const Eigen::Index n = a.rows(), shares = panels(n, kShare);
  std::vector<Eigen::MatrixXd> sums(static_cast<std::size_t>(shares), Eigen::MatrixXd::Zero(a.cols(), b.cols()));
  tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t share) {
    Packed packed;
    const Eigen::Index begin = kShare * static_cast<Eigen::Index>(share), end = std::min(n, begin + kShare);
    for (Eigen::Index at = begin; at < end; at += kBlock) {
      const Eigen::Index rows = std::min(kBlock, end - at);
      pack(a.middleRows(at, rows), kTile, packed.left);
      pack(b.middleRows(at, rows), kLanes, packed.right);
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
    pack(a.middleRows(at, rows), kTile, packed.left);
    pack(a.middleRows(at, rows), kLanes, packed.right);
    add_tiles(packed, rows, true, sum_);
  }
  sum_.triangularView<Eigen::StrictlyUpper>() = sum_.transpose();
}

}  // namespace tissue_stiffness
