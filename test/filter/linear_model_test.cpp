// The parameter filter on linear and quadratic models, against the formulas of least squares with a prior.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "filter/posterior_linearization_filter.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// y = H w + offset, with rows of different noise and weight; the prior's mean is away from the anchor.
class LinearModel : public testing::Test {
 protected:
  LinearModel() {
    h_ << 2.0, -1.0, 0.5, 3.0, 1.0, 1.0, -2.0, 0.25;
    prior_covariance_ << 4.0, 1.0, 1.0, 2.0;
    filter_.move_anchor(anchor_, spread_);
  }

  Eigen::MatrixXd predictions() const { return (h_ * filter_.sigma_points()).colwise() + offset_; }
  Eigen::VectorXd error() const { return y_ - h_ * anchor_ - offset_; }
  Eigen::VectorXd precision() const { return weight_.cwiseQuotient(variance_); }
  double cost() const { return error().cwiseAbs2().dot(precision()); }
  Eigen::Matrix2d data_information() const { return h_.transpose() * precision().asDiagonal() * h_; }
  Eigen::Vector2d pull() const { return h_.transpose() * precision().cwiseProduct(error()); }
  PosteriorLinearizationFilter::Innovation update() { return filter_.update(y_, predictions(), variance_, weight_); }

  Eigen::Matrix<double, 4, 2> h_;
  Eigen::Vector4d offset_{0.1, -0.2, 0.3, 1.0}, y_{1.5, 2.0, 1.0, -3.0};
  Eigen::Vector4d variance_{0.04, 0.25, 1.0, 0.09}, weight_{1.0, 0.5, 1.0, 0.8};
  Eigen::Vector2d prior_mean_{0.3, -0.4}, anchor_{0.8, 0.6}, spread_{0.5, 0.2};
  Eigen::Matrix2d prior_covariance_;
  PosteriorLinearizationFilter filter_{prior_mean_, (Eigen::Matrix2d() << 4.0, 1.0, 1.0, 2.0).finished()};
};

TEST_F(LinearModel, GivesThePosteriorOfLeastSquares) {
  const auto innovation = update();
  EXPECT_EQ(innovation.dof, 4);
  EXPECT_NEAR(innovation.cost, cost(), 1e-12 * cost());
  const double scale = cost() / 4.0;
  ASSERT_GT(scale, 1.0);
  EXPECT_NEAR(filter_.misfit_scale(), scale, 1e-12 * scale);
  EXPECT_NEAR(filter_.mean_square(), scale, 1e-12 * scale);
  const Eigen::Matrix2d prior = prior_covariance_.inverse(), information = data_information() / scale + prior;
  EXPECT_TRUE(filter_.covariance().isApprox(information.inverse(), 1e-12));
  const Eigen::Vector2d gradient = pull() / scale + prior * (prior_mean_ - anchor_);
  EXPECT_TRUE(filter_.mean().isApprox(anchor_ + information.inverse() * gradient, 1e-12));
  Eigen::Matrix2d damped = information;
  damped.diagonal() *= 1.3;
  EXPECT_TRUE(filter_.mean(0.3).isApprox(anchor_ + damped.inverse() * gradient, 1e-12));
  EXPECT_NEAR(filter_.nonlinearity(), 0.0, 1e-20);
}

TEST_F(LinearModel, GivesTheInnovationsTest) {
  update();
  const double scale = filter_.misfit_scale();
  const Eigen::Matrix2d before = (scale * filter_.covariance().inverse()).inverse();
  const Eigen::Vector4d innovation = y_ - h_ * filter_.mean() - offset_;
  Eigen::Matrix4d noise = precision().cwiseInverse().asDiagonal();
  const Eigen::Matrix4d expected = h_ * before * h_.transpose() + noise;
  const double nis = innovation.dot(expected.inverse() * innovation);
  EXPECT_NEAR(update().nis, nis, 1e-9 * nis);
}

TEST_F(LinearModel, TakesGoodDataForNoBetterThanTheSensor) {
  y_ = h_ * Eigen::Vector2d(0.85, 0.62) + offset_;
  update();
  ASSERT_LT(filter_.mean_square(), 1.0);
  EXPECT_EQ(filter_.misfit_scale(), 1.0);
  EXPECT_TRUE(filter_.covariance().isApprox((data_information() + prior_covariance_.inverse()).inverse(), 1e-12));
}

TEST_F(LinearModel, KnowsThePriorAloneBeforeData) {
  EXPECT_TRUE(filter_.covariance().isApprox(prior_covariance_, 1e-12));
  EXPECT_TRUE(filter_.mean().isApprox(prior_mean_, 1e-12));
  EXPECT_EQ(filter_.misfit_scale(), 1.0);
  EXPECT_EQ(filter_.mean_square(), 0.0);
  EXPECT_EQ(filter_.nonlinearity(), 0.0);
}

TEST_F(LinearModel, LeavesRowsOutThatAreNotUsable) {
  PosteriorLinearizationFilter whole = filter_;
  whole.update(y_.head(2), predictions().topRows(2), variance_.head(2), weight_.head(2));
  y_[2] = kNotANumber;
  variance_[3] = 0.0;
  EXPECT_EQ(update().dof, 2);
  EXPECT_EQ(filter_.rows(), 2);
  EXPECT_TRUE(filter_.mean().isApprox(whole.mean(), 1e-14));
  EXPECT_TRUE(filter_.covariance().isApprox(whole.covariance(), 1e-14));
}

TEST_F(LinearModel, ForgetsTheDataWhenTheAnchorMoves) {
  update();
  filter_.move_anchor(anchor_, spread_);
  EXPECT_TRUE(filter_.covariance().isApprox(prior_covariance_, 1e-12));
  EXPECT_EQ(filter_.rows(), 0);
  EXPECT_EQ(filter_.mean_square(), 0.0);
}

TEST_F(LinearModel, CountsThePriorInTheCost) {
  update();
  const double scale = filter_.misfit_scale();
  const Eigen::Vector2d w(1.0, 2.0), step = w - prior_mean_;
  const double prior = step.dot(prior_covariance_.inverse() * step);
  EXPECT_NEAR(filter_.cost_at(w, 24.0, 4.0), 24.0 + 6.0 * prior, 1e-10);
  EXPECT_NEAR(filter_.cost_at(w, 2.0, 4.0), 2.0 + prior, 1e-10);
  EXPECT_NEAR(filter_.cost_at(w, 5.0, 0.0), 5.0 + prior, 1e-10);
  const Eigen::Vector2d back = anchor_ - prior_mean_;
  EXPECT_NEAR(filter_.cost(), cost() + scale * back.dot(prior_covariance_.inverse() * back), 1e-10);
}

TEST_F(LinearModel, InterpolatesThePrediction) {
  const Eigen::Vector2d w(1.0, 2.0);
  EXPECT_TRUE(filter_.predict(predictions(), w).isApprox(h_ * w + offset_, 1e-12));
  EXPECT_TRUE(filter_.slopes(predictions()).isApprox(h_, 1e-12));
}

TEST_F(LinearModel, IsStaleWhereTheEstimateIsFarOrMuchSharperThanTheSpread) {
  update();
  const Eigen::Array2d step = (filter_.mean() - anchor_).array().abs() / spread_.array();
  const Eigen::Array2d wide = spread_.array() / filter_.covariance().diagonal().array().sqrt();
  const Eigen::Vector2d none = Eigen::Vector2d::Zero();
  const double far = 1.01 * step.maxCoeff(), sharp = 1.01 * wide.maxCoeff();
  EXPECT_FALSE(filter_.stale(far, sharp, none));
  EXPECT_TRUE(filter_.stale(0.98 * far, sharp, none));
  EXPECT_TRUE(filter_.stale(far, 0.98 * sharp, none));
  EXPECT_FALSE(filter_.stale(far, 0.98 * sharp, 1.01 * spread_)) << "the spread is below its floor";
}

TEST(CurvedModel, AddsTheCurvatureToTheNoise) {
  PosteriorLinearizationFilter filter(Eigen::VectorXd::Constant(1, 2.0), Eigen::MatrixXd::Constant(1, 1, 0.25));
  // The prediction is 3 w + 2 (w - 2)^2, whose bend over a spread of 0.5 is 0.5, where the noise is 0.1.
  Eigen::RowVector3d predictions(6.0, 8.0, 5.0);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  filter.update(6.2 * one, predictions, 0.01 * one, one);
  EXPECT_NEAR(filter.mean_square(), 4.0, 1e-9);
  EXPECT_NEAR(filter.nonlinearity(), 25.0, 1e-9);
  const double information = 9.0 / (0.01 + 0.25) / 4.0 + 4.0;
  EXPECT_NEAR(filter.covariance()(0, 0), 1.0 / information, 1e-12);
  EXPECT_NEAR(filter.mean()[0], 2.0 + 3.0 * 0.2 / (0.01 + 0.25) / 4.0 / information, 1e-12);
}

// Errors of one sign in each batch widen the covariance, by what they are in units of the noise, however large that is.
TEST(RobustCovariance, DoesNotDependOnTheUnitOfTheNoise) {
  const auto widening = [](double noise) {
    PosteriorLinearizationFilter filter(Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Constant(1, 1, 1e12));
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
    for (int k = 0; k < 64; ++k) {
      const double error = (k / 4 % 2 == 0 ? 3.0 : -3.0) + (k % 2 == 0 ? 1.0 : -1.0);
      filter.update(error * one, filter.sigma_points(), noise * noise * one, one);
    }
    return filter.robust_covariance()(0, 0) / filter.covariance()(0, 0);
  };
  EXPECT_GT(widening(1.0), 2.0);
  EXPECT_NEAR(widening(0.1), widening(1.0), 1e-6 * widening(1.0));
}

}  // namespace
}  // namespace tissue_stiffness
