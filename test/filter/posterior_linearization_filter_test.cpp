// The filter's covariance under whatever rows come.
#include "filter/posterior_linearization_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>

namespace tissue_stiffness {
namespace {

constexpr int kFilters = 20000;
constexpr int kUpdates = 50;  // of each
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

class RandomUpdates {
 public:
  double uniform(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(random_); }
  double decade(double lower, double upper) { return std::pow(10.0, uniform(lower, upper)); }
  bool once_in(double count) { return uniform(0.0, count) < 1.0; }
  int integer(int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(random_); }

  Eigen::MatrixXd normal(Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd out(rows, columns);
    for (Eigen::Index i = 0; i < out.size(); ++i) out.data()[i] = normal_(random_);
    return out;
  }

  // A covariance whose standard deviations differ by decades, and whose directions are almost the same now and then.
  Eigen::MatrixXd covariance(Eigen::Index p) {
    Eigen::MatrixXd root = normal(p, p);
    if (once_in(3.0)) {
      for (Eigen::Index i = 1; i < p; ++i) root.row(i) = root.row(0) + decade(-5.0, 0.0) * root.row(i);
    }
    Eigen::VectorXd scale(p);
    for (Eigen::Index i = 0; i < p; ++i) scale[i] = decade(-3.0, 3.0);
    const Eigen::MatrixXd scaled = scale.asDiagonal() * root;
    Eigen::MatrixXd out = scaled * scaled.transpose();
    out.diagonal() *= 1.0 + 1e-9;
    return out;
  }

  // A number that no sensor should send, now and then.
  template <typename Values>
  void spoil(Values& values) {
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      if (once_in(100.0)) values.data()[i] = once_in(2.0) ? kNotANumber : INFINITY;
    }
  }

 private:
  std::mt19937 random_{20};
  std::normal_distribution<double> normal_;
};

TEST(PosteriorLinearization, TheCovarianceStaysPositiveDefiniteInAMillionRandomUpdates) {
  RandomUpdates draw;
  for (int k = 0; k < kFilters; ++k) {
    const Eigen::Index p = draw.integer(1, 4);
    const Eigen::MatrixXd prior = draw.covariance(p);
    PosteriorLinearizationFilter filter(draw.normal(p, 1), prior);
    const double size = draw.decade(-6.0, 3.0), noise = draw.decade(-8.0, 2.0);
    for (int i = 0; i < kUpdates; ++i) {
      const Eigen::Index m = draw.integer(0, 4);
      Eigen::MatrixXd predictions = size * draw.normal(m, 2 * p + 1);
      // One direction of the parameters alone, as where the data hold a ratio only.
      if (draw.once_in(4.0)) predictions.rightCols(2 * p).colwise() = Eigen::VectorXd(size * draw.normal(m, 1));
      Eigen::VectorXd y = size * draw.normal(m, 1), variance(m), weight(m);
      for (Eigen::Index r = 0; r < m; ++r) {
        variance[r] = std::pow(noise * draw.decade(-1.0, 1.0), 2);
        weight[r] = draw.once_in(4.0) ? draw.decade(-12.0, 0.0) : 1.0;
      }
      draw.spoil(predictions);
      draw.spoil(y);
      draw.spoil(variance);
      const auto innovation = filter.update(y, predictions, variance, weight);
      const Eigen::MatrixXd covariance = filter.covariance();
      ASSERT_TRUE(covariance.allFinite()) << k << ", " << i;
      ASSERT_TRUE(filter.mean().allFinite()) << k << ", " << i;
      ASSERT_TRUE(std::isfinite(innovation.nis)) << k << ", " << i;
      // Scaled, because the units of the parameters differ by decades.
      const Eigen::VectorXd std = covariance.diagonal().cwiseSqrt();
      ASSERT_TRUE((covariance.diagonal().array() > 0.0).all()) << k << ", " << i << "\n" << covariance;
      const Eigen::MatrixXd correlation = std.cwiseInverse().asDiagonal() * covariance * std.cwiseInverse().asDiagonal();
      ASSERT_TRUE(correlation.llt().info() == Eigen::Success) << k << ", " << i << "\n" << correlation;
      ASSERT_TRUE((std.array() <= 1.001 * prior.diagonal().array().sqrt()).all()) << "data took knowledge away";
    }
  }
}

}  // namespace
}  // namespace tissue_stiffness
