#include "fem/nonnegative_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fem/products.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kDependent = 1e-10;  // share of its square that a new column has to keep beside the others
constexpr double kNothing = 1e-14;    // of a weight or a gradient

// The columns in use, with their Gram matrix L L^T.
class ActiveSet {
 public:
  ActiveSet(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, Eigen::Index most)
      : a_(a),
        products_(a.transpose() * b),
        columns_(a.rows(), most),
        gram_(most, most),
        lower_(most, most),
        weights_(most) {}

  Eigen::Index size() const { return static_cast<Eigen::Index>(used_.size()); }
  const std::vector<Eigen::Index>& used() const { return used_; }
  auto weights() const { return weights_.head(size()); }
  Eigen::VectorXd product() const { return columns_.leftCols(size()) * weights(); }

  // Returns false if the column depends on those in use.
  bool add(Eigen::Index column) {
    const Eigen::Index n = size();
    columns_.col(n) = a_.col(column);
    gram_.col(n).head(n + 1) = columns_.leftCols(n + 1).transpose() * a_.col(column);
    gram_.row(n).head(n) = gram_.col(n).head(n).transpose();
    if (!extend(n)) return false;
    used_.push_back(column);
    weights_[n] = 0.0;
    settle();
    return true;
  }

 private:
  // Adds a row to the triangle.
  bool extend(Eigen::Index n) {
    Eigen::VectorXd row = gram_.col(n).head(n);
    lower_.topLeftCorner(n, n).triangularView<Eigen::Lower>().solveInPlace(row);
    const double rest = gram_(n, n) - row.squaredNorm();
    if (!(rest > kDependent * gram_(n, n))) return false;
    lower_.row(n).head(n) = row.transpose();
    lower_(n, n) = std::sqrt(rest);
    return true;
  }

  Eigen::VectorXd unconstrained() const {
    const Eigen::Index n = size();
    Eigen::VectorXd x(n);
    for (Eigen::Index i = 0; i < n; ++i) x[i] = products_[used_[static_cast<std::size_t>(i)]];
    const auto l = lower_.topLeftCorner(n, n).triangularView<Eigen::Lower>();
    l.solveInPlace(x);
    l.adjoint().solveInPlace(x);
    return x;
  }

  // Moves towards the least squares solution, and drops columns whose weight becomes zero on the way.
  void settle() {
    while (size() > 0) {
      const Eigen::VectorXd goal = unconstrained();
      double step = 1.0;
      for (Eigen::Index i = 0; i < goal.size(); ++i) {
        if (goal[i] <= 0.0) step = std::min(step, weights_[i] / (weights_[i] - goal[i]));
      }
      weights_.head(size()) += step * (goal - weights_.head(size()));
      if (step >= 1.0) return;
      drop();
    }
  }

  // Leaves out columns without weight, and makes the triangle again from the first of them on.
  void drop() {
    const double least = kNothing * weights().maxCoeff();
    Eigen::Index kept = 0, first = size();
    for (Eigen::Index i = 0; i < size(); ++i) {
      if (weights_[i] <= least) {
        first = std::min(first, i);
        continue;
      }
      if (kept < i) move(i, kept);
      ++kept;
    }
    used_.resize(static_cast<std::size_t>(kept));
    for (Eigen::Index i = first; i < kept; ++i) extend(i);
  }

  void move(Eigen::Index from, Eigen::Index to) {
    columns_.col(to) = columns_.col(from);
    gram_.col(to) = gram_.col(from).eval();
    gram_.row(to) = gram_.row(from).eval();
    weights_[to] = weights_[from];
    used_[static_cast<std::size_t>(to)] = used_[static_cast<std::size_t>(from)];
  }

  const Eigen::MatrixXd& a_;
  Eigen::VectorXd products_;  ///< A^T b
  Eigen::MatrixXd columns_, gram_, lower_;
  Eigen::VectorXd weights_;
  std::vector<Eigen::Index> used_;
};

}  // namespace

SparseWeights nonnegative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double tolerance,
                                        Eigen::Index most) {
  ActiveSet active(a, b, std::min(most, a.cols()));
  const Eigen::VectorXd sizes = a.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
  std::vector<char> barred(static_cast<std::size_t>(a.cols()), 0);
  const double whole = b.norm();
  Eigen::VectorXd residual = b;
  double left = 1.0;
  while (whole > 0.0 && left > tolerance && active.size() < std::min(most, a.cols())) {
    Eigen::VectorXd slope = inner_products(a, residual).col(0).cwiseQuotient(sizes);
    for (const Eigen::Index used : active.used()) slope[used] = 0.0;
    for (Eigen::Index i = 0; i < slope.size(); ++i) {
      if (barred[static_cast<std::size_t>(i)] != 0) slope[i] = 0.0;
    }
    Eigen::Index best = 0;
    if (!(slope.maxCoeff(&best) > kNothing * whole)) break;
    barred[static_cast<std::size_t>(best)] = 1;  // until the residual is smaller
    if (!active.add(best)) continue;
    residual = b - active.product();
    if (const double now = residual.norm() / whole; now < left) {
      left = now;
      std::fill(barred.begin(), barred.end(), char{0});
    }
  }
  std::vector<Eigen::Index> order(active.used().size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::sort(order.begin(), order.end(), [&](Eigen::Index i, Eigen::Index k) {
    return active.used()[static_cast<std::size_t>(i)] < active.used()[static_cast<std::size_t>(k)];
  });
  SparseWeights out{{}, Eigen::VectorXd(active.size()), whole > 0.0 ? left : 0.0};
  for (std::size_t i = 0; i < order.size(); ++i) {
    out.columns.push_back(active.used()[static_cast<std::size_t>(order[i])]);
    out.weights[static_cast<Eigen::Index>(i)] = active.weights()[order[i]];
  }
  return out;
}

}  // namespace tissue_stiffness
