#include "fem/two_grid.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/panel.hpp"
#include "fem/products.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Row = Eigen::Matrix<float, 1, Eigen::Dynamic>;
using Sums = Eigen::RowVectorXd;  // of squares, a column each

constexpr int kSweeps = 3;                 // a smoothing's products
constexpr float kSmoothed = 8.0F;          // of the spectrum: the upper part that smoothing is for begins at 1 / 8
constexpr double kSafety = 1.1;            // of the largest eigenvalue that was found
constexpr int kPowers = 12;                // iterations that find it
constexpr double kTolerance = 3e-2;        // of a residual in the preconditioner's norm, before a last V-cycle
constexpr int kTrials = 3;                 // V-cycles that tell how fast errors fall
constexpr double kSlow = 0.71;             // what the last may leave: where Poisson's ratio is 0.48, about
constexpr int kMostIterations = 12;        // more are no faster than a factor
constexpr Eigen::Index kMostColumns = 32;  // at once
constexpr Eigen::Index kGrain = 512, kShare = 4096;  // rows of a task, and of a summand
constexpr Eigen::Index kBlock = 256;                 // columns of a product of matrices that are a task

template <typename Work>
void each_row(Eigen::Index rows, const Work& work) {
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, rows, kGrain), [&](const auto& part) {
    for (Eigen::Index j = part.begin(); j < part.end(); ++j) work(j);
  });
}

// Returns the product of each column, independent of the number of cores.
Sums dot(const Rows& a, const Rows& b) {
  const Eigen::Index shares = (a.rows() + kShare - 1) / kShare;
  Eigen::MatrixXd sums(a.cols(), shares);
  tbb::parallel_for(Eigen::Index{0}, shares, [&](Eigen::Index share) {
    const Eigen::Index begin = kShare * share, count = std::min(kShare, a.rows() - begin);
    const Row sum = (a.middleRows(begin, count).array() * b.middleRows(begin, count).array()).colwise().sum();
    sums.col(share) = sum.transpose().cast<double>();
  });
  return sums.rowwise().sum().transpose();
}

// Returns a value that contains all wavelengths.
double wave(Eigen::Index i) {
  return std::cos(2.4 * static_cast<double>(i));
}

// Computes to = by * from.
void interpolate(const Prolongation& by, const Rows& from, Rows& to) {
  each_row(by.rows(), [&](Eigen::Index j) {
    to.row(j).setZero();
    for (Prolongation::InnerIterator entry(by, j); entry; ++entry) {
      to.row(j) += static_cast<float>(entry.value()) * from.row(entry.col());
    }
  });
}

enum class Coarse { all, free };

// Limits the prolongation to free degrees of freedom of the fine mesh. On the coarse mesh it takes all of them, or the free
// ones.
Prolongation of_degrees_of_freedom(const Prolongation& nodes, const std::vector<char>& fixed, Coarse coarse) {
  const auto held = [&fixed](Eigen::Index dof) { return fixed[static_cast<std::size_t>(dof)] != 0; };
  std::vector<Eigen::Triplet<double>> list;
  list.reserve(3 * static_cast<std::size_t>(nodes.nonZeros()));
  for (Eigen::Index node = 0; node < nodes.rows(); ++node) {
    for (Prolongation::InnerIterator entry(nodes, node); entry; ++entry) {
      for (Eigen::Index c = 0; c < 3; ++c) {
        if (held(3 * node + c) || (coarse == Coarse::free && held(3 * entry.col() + c))) continue;
        list.emplace_back(static_cast<int>(3 * node + c), static_cast<int>(3 * entry.col() + c), entry.value());
      }
    }
  }
  Prolongation out(3 * nodes.rows(), 3 * nodes.cols());
  out.setFromTriplets(list.begin(), list.end());
  return out;
}

// Degrees of freedom without entries get a diagonal, so that they stay where they are.
void hold_idle(SparseMatrix& matrix) {
  const Eigen::VectorXd diagonal = matrix.diagonal(), none = Eigen::VectorXd::Zero(diagonal.size());
  const Eigen::VectorXd idle = (diagonal.array() == 0.0).select(diagonal.mean(), none);
  matrix += SparseMatrix(idle.asDiagonal());
}

}  // namespace

// Several right-hand sides at once, with a row for each degree of freedom.
class TwoGrid::Iteration {
 public:
  Iteration(const TwoGrid& system, Eigen::Index columns)
      : a_(system), columns_(columns), width_(kFloatWidth * ((columns + kFloatWidth - 1) / kFloatWidth)) {
    for (Rows* rows : {&x_, &r_, &z_, &p_, &rest_, &d_, &next_}) rows->setZero(a_.matrix_.rows(), width_);
    coarse_.setZero(a_.prolongation_.cols(), width_);
  }

  // Returns the factor by which one more V-cycle reduces an error's energy norm, after some V-cycles have acted on the
  // error.
  double slowest() {
    for (Eigen::Index i = 0; i < x_.rows(); ++i) x_(i, 0) = static_cast<float>(wave(i));
    double before = 0.0, energy = 0.0;
    for (int k = 0; k <= kTrials; ++k) {
      if (k > 0) {
        v_cycle();
        x_ -= z_;
      }
      multiply(x_, [&](Eigen::Index j, const auto& product) { r_.row(j) = product; });
      before = std::exchange(energy, dot(x_, r_)[0]);
    }
    return std::sqrt(energy / before);
  }

  bool operator()(const Eigen::Ref<const Eigen::MatrixXd>& b, Eigen::Ref<Eigen::MatrixXd> out) {
    const Eigen::RowVectorXd largest = b.cwiseAbs().colwise().maxCoeff(),
                             size = (largest.array() > 0.0).select(largest, 1.0);
    r_.leftCols(columns_) = (b.array().rowwise() / size.array()).cast<float>();
    v_cycle();
    p_ = z_;
    Sums power = dot(r_, z_);
    const Sums first = power;
    for (int k = 0; k < kMostIterations; ++k) {
      multiply(p_, [&](Eigen::Index j, const auto& product) { rest_.row(j) = product; });
      const Row along = ratio(power, dot(p_, rest_)).cast<float>();
      each_row(x_.rows(), [&](Eigen::Index j) {
        x_.row(j).array() += along.array() * p_.row(j).array();
        r_.row(j).array() -= along.array() * rest_.row(j).array();
      });
      v_cycle();
      const Sums now = dot(r_, z_), left = ratio(now, first);
      if (!left.allFinite()) return false;
      if (std::sqrt(left.maxCoeff()) < kTolerance) {
        out = (x_ + z_).leftCols(columns_).cast<double>().array().rowwise() * size.array();
        return true;
      }
      const Row keep = ratio(now, power).cast<float>();
      each_row(p_.rows(), [&](Eigen::Index j) { p_.row(j) = z_.row(j).array() + keep.array() * p_.row(j).array(); });
      power = now;
    }
    return false;
  }

 private:
  // Columns of zeros are already solved and stay zero.
  static Sums ratio(const Sums& a, const Sums& b) { return (b.array() == 0.0).select(0.0, a.array() / b.array()); }

  // Calls then(j, row j of the product of A and `of`).
  template <typename Then>
  void multiply(const Rows& of, const Then& then) const {
    each_row(a_.single_.nodes(), [&](Eigen::Index node) {
      alignas(64) float sum[3 * kMostColumns];
      a_.single_.multiply(static_cast<int>(node), of.data(), width_, sum);
      for (int i = 0; i < 3; ++i) then(3 * node + i, Eigen::Map<const Row>(sum + width_ * i, width_));
    });
  }

  // Computes z, an approximation of A^-1 r.
  void v_cycle() {
    rest_ = r_;
    z_.setZero();
    smooth();
    multiply(d_, [&](Eigen::Index j, const auto& product) { rest_.row(j) -= product; });
    interpolate(a_.restriction_, rest_, coarse_);
    coarse_.leftCols(columns_) = a_.solve_coarse(coarse_.leftCols(columns_).cast<double>()).cast<float>();
    interpolate(a_.prolongation_, coarse_, d_);
    multiply(d_, [&](Eigen::Index j, const auto& product) {
      rest_.row(j) -= product;
      z_.row(j) += d_.row(j);
    });
    smooth();
  }

  // Runs a Chebyshev iteration from z on (Saad, Iterative Methods for Sparse Linear Systems, 2003, algorithm 12.1). `rest_`
  // is the residual of z before its last change, which is `d_`.
  void smooth() {
    const auto upper = static_cast<float>(a_.largest_), lower = upper / kSmoothed;
    const float middle = 0.5F * (upper + lower), half = 0.5F * (upper - lower), sigma = middle / half;
    float rho = 1.0F / sigma;
    each_row(d_.rows(), [&](Eigen::Index j) {
      d_.row(j) = (a_.inverse_diagonal_[j] / middle) * rest_.row(j);
      z_.row(j) += d_.row(j);
    });
    for (int k = 1; k < kSweeps; ++k) {
      const float next_rho = 1.0F / (2.0F * sigma - rho), keep = next_rho * rho, step = 2.0F * next_rho / half;
      multiply(d_, [&](Eigen::Index j, const auto& product) {
        rest_.row(j) -= product;
        next_.row(j) = keep * d_.row(j) + (step * a_.inverse_diagonal_[j]) * rest_.row(j);
        z_.row(j) += next_.row(j);
      });
      d_.swap(next_);
      rho = next_rho;
    }
  }

  const TwoGrid& a_;
  Eigen::Index columns_, width_;
  Rows x_, r_, z_, p_, rest_, d_, next_, coarse_;
};

TwoGrid::TwoGrid(SparseMatrix&& matrix, const std::vector<char>& fixed, const Prolongation& nodes) {
  move_matrix(matrix_, std::move(matrix));
  tbb::parallel_invoke([&] { single_ = SingleMatrix(matrix_); }, [&] { find_spectrum(); }, [&] { couple(fixed, nodes); });
  slow_ = !(Iteration(*this, 1).slowest() < kSlow);
}

// Coarse functions of held nodes help near a face. Where few free nodes share many of them, they are linearly dependent.
void TwoGrid::couple(const std::vector<char>& fixed, const Prolongation& nodes) {
  const auto to = [&](Coarse coarse) {
    prolongation_ = of_degrees_of_freedom(nodes, fixed, coarse);
    restriction_ = prolongation_.transpose();
    SparseMatrix below = to_coarse(matrix_);
    hold_idle(below);
    coarse_.factorize(below);
  };
  try {
    to(Coarse::all);
  } catch (const NumericalError&) {
    to(Coarse::free);
  }
}

// Finds the largest eigenvalue by power iteration.
void TwoGrid::find_spectrum() {
  const Eigen::VectorXd diagonal = matrix_.diagonal();
  inverse_diagonal_ = diagonal.cwiseInverse().cast<float>();
  Eigen::VectorXd x(matrix_.rows());
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = wave(i);
  for (int k = 0; k < kPowers; ++k) {
    const Eigen::VectorXd y = symmetric_product(matrix_, x).col(0).cwiseQuotient(diagonal);
    largest_ = kSafety * y.norm() / x.norm();
    x = y.normalized();
  }
}

Eigen::MatrixXd TwoGrid::to_fine(const Eigen::MatrixXd& x) const {
  return prolongation_ * x;
}

Eigen::MatrixXd TwoGrid::to_coarse(const Eigen::MatrixXd& b) const {
  return restriction_ * b;
}

SparseMatrix TwoGrid::to_coarse(const SparseMatrix& s) const {
  const SparseMatrix down = prolongation_, up = restriction_;
  const Eigen::Index count = (down.cols() + kBlock - 1) / kBlock;
  std::vector<SparseMatrix> blocks(static_cast<std::size_t>(count));
  tbb::parallel_for(Eigen::Index{0}, count, [&](Eigen::Index i) {
    const Eigen::Index begin = kBlock * i;
    const SparseMatrix product = s * SparseMatrix(down.middleCols(begin, std::min(kBlock, down.cols() - begin)));
    blocks[static_cast<std::size_t>(i)] = up * product;
  });
  SparseMatrix out(down.cols(), down.cols());
  Eigen::Index size = 0;
  for (const SparseMatrix& block : blocks) size += block.nonZeros();
  out.reserve(size);
  Eigen::Index column = 0;
  for (const SparseMatrix& block : blocks) {
    for (Eigen::Index j = 0; j < block.cols(); ++j, ++column) {
      out.startVec(column);
      for (SparseMatrix::InnerIterator entry(block, j); entry; ++entry) {
        out.insertBack(entry.row(), column) = entry.value();
      }
    }
  }
  out.finalize();
  return out;
}

std::optional<Eigen::MatrixXd> TwoGrid::solve(const Eigen::MatrixXd& b) const {
  if (slow_) return std::nullopt;
  Eigen::MatrixXd x(b.rows(), b.cols());
  for (Eigen::Index at = 0; at < b.cols(); at += kMostColumns) {
    const Eigen::Index count = std::min(kMostColumns, b.cols() - at);
    if (!Iteration(*this, count)(b.middleCols(at, count), x.middleCols(at, count))) return std::nullopt;
  }
  return x;
}

}  // namespace tissue_stiffness
