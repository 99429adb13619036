#include "filter/unscented_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "../figures.hpp"
#include "../processor_time.hpp"
#include "filter/consistency.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

class UnscentedFilters : public ::testing::Test {
 protected:
  Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index columns) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(engine_); });
  }
  Eigen::MatrixXd random_covariance(Eigen::Index size) {
    const Eigen::MatrixXd root = random(size, size);
    return root * root.transpose() / static_cast<double>(size) + 0.1 * Eigen::MatrixXd::Identity(size, size);
  }
  std::mt19937 engine_{7};
};

const std::vector<UnscentedTuning> tunings = {{1.0, 2.0, 0.0}, {0.3, 2.0, 0.0}, {2.0, 2.0, 0.0}, {0.5, 0.0, 1.0}};

TEST(Kalman, TheUnscentedFilterEqualsItOnLinearModels) {
  expect_all(kalman_figures());
}

/// A curved model, where only the algebra can agree: eq. 18-23 written out.
TEST_F(UnscentedFilters, EqualEquations18To23OnACurvedModel) {
  for (const UnscentedTuning& tuning : tunings) {
    const int l = 3, m = 20;
    const Eigen::VectorXd mean = random(l, 1), y = random(m, 1);
    const Eigen::MatrixXd covariance = random_covariance(l), h = random(m, l), r = random_covariance(m);
    const SigmaModel model = [&](const Eigen::MatrixXd& x) -> Eigen::MatrixXd { return (h * x).array().sin().matrix(); };

    const SigmaSet set = SigmaSet::scaled(l, tuning);
    const Eigen::MatrixXd factor = covariance.llt().matrixL();
    const Eigen::MatrixXd points = set.points(mean, factor), outputs = model(points);
    const Eigen::VectorXd predicted = outputs * set.mean_weights();
    const Eigen::MatrixXd dy = outputs.colwise() - predicted, dx = points.colwise() - mean;
    const auto w = set.covariance_weights().asDiagonal();
    const Eigen::MatrixXd p_d = dy * w * dy.transpose() + r, p_wd = dx * w * dy.transpose();
    const Eigen::MatrixXd gain = p_wd * p_d.inverse();
    const Eigen::VectorXd expected_mean = mean + gain * (y - predicted);
    const Eigen::MatrixXd expected_covariance = covariance - gain * p_d * gain.transpose();

    UnscentedFilter filter(mean, covariance, tuning);
    const FilterUpdate update = filter.update(y, model(filter.sigma_points()), Noise::correlated(r));
    EXPECT_LT((filter.mean() - expected_mean).norm(), 1e-11);
    EXPECT_LT((filter.covariance() - expected_covariance).norm(), 1e-11);
    EXPECT_NEAR(update.nis, normalised_squared(y - predicted, p_d), 1e-10);
    EXPECT_LT((update.innovation_sigma - p_d.diagonal().cwiseSqrt()).norm(), 1e-11);
    const double log_likelihood = -0.5 * (update.nis + std::log(p_d.determinant()) + m * std::log(2.0 * std::acos(-1.0)));
    EXPECT_NEAR(update.log_likelihood, log_likelihood, 1e-9);
  }
}

void expect_semidefinite(const UnscentedFilter& filter) {
  ASSERT_TRUE(filter.mean().allFinite());
  ASSERT_TRUE(filter.square_root().allFinite());
  EXPECT_GE(filter.square_root().diagonal().minCoeff(), 0.0);
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(filter.covariance()).eigenvalues();
  EXPECT_GE(eigenvalues.minCoeff(), -1e-15 * eigenvalues.maxCoeff());
}

TEST_F(UnscentedFilters, StayPositiveSemidefiniteWhateverComes) {
  for (const UnscentedTuning& tuning :
       {UnscentedTuning{1e-3, 2.0, 0.0}, {0.1, 0.0, 0.0}, {2.0, 0.0, 0.0}, {1.0, 2.0, 0.0}}) {
    const int l = 4, m = 6;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(l, l);
    covariance.diagonal() << 1e8, 1.0, 1e-12, 0.0;
    UnscentedFilter filter(Eigen::VectorXd::Ones(l), covariance, tuning);
    for (int step = 0; step < 200; ++step) {
      const Eigen::MatrixXd h = random(m, l);
      const SigmaModel curved = [&](const Eigen::MatrixXd& x) -> Eigen::MatrixXd {
        return ((h * x).array().square() / (1.0 + (h * x).array().abs())).matrix();
      };
      const SigmaModel folded = [&](const Eigen::MatrixXd& x) -> Eigen::MatrixXd { return x.cwiseAbs(); };
      const double sigma = step % 3 == 0 ? 1e-10 : 1e3;  // measurements that leave nothing, and others that say nothing
      if (step % 2 == 0) filter.predict(folded, Eigen::MatrixXd::Zero(l, 1));
      filter.update(1e4 * random(m, 1), curved(filter.sigma_points()),
                    Noise::independent(Eigen::VectorXd::Constant(m, sigma)));
      expect_semidefinite(filter);
    }
  }
}

// Eq. 23 as printed would cancel completely here.
TEST_F(UnscentedFilters, AMeasurementThatLeavesNothingIsTaken) {
  UnscentedFilter filter(Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Identity(1, 1));
  const Eigen::MatrixXd outputs = Eigen::MatrixXd::Ones(2, 1) * filter.sigma_points();
  filter.update(Eigen::VectorXd::Ones(2), outputs, Noise::independent(Eigen::VectorXd::Constant(2, 1e-12)));
  EXPECT_NEAR(filter.mean()[0], 1.0, 1e-12);
  EXPECT_NEAR(filter.square_root()(0, 0), 1e-12 / std::sqrt(2.0), 1e-20);
}

TEST_F(UnscentedFilters, AFailedUpdateChangesNothing) {
  UnscentedFilter filter(Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Identity(1, 1));
  Eigen::MatrixXd outputs = Eigen::MatrixXd::Ones(2, 1) * filter.sigma_points();
  outputs.col(1).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(filter.update(Eigen::VectorXd::Ones(2), outputs, Noise::independent(Eigen::VectorXd::Ones(2))),
               NumericalError);
  EXPECT_EQ(filter.mean()[0], 0.0);
  EXPECT_EQ(filter.covariance()(0, 0), 1.0);
}

TEST_F(UnscentedFilters, MissingRowsAreLeftOut) {
  const int l = 2, m = 7;
  const Eigen::MatrixXd h = random(m, l);
  Eigen::VectorXd y = random(m, 1), sigma = Eigen::VectorXd::Constant(m, 0.5);
  const std::vector<int> kept = {0, 2, 4, 5};
  Eigen::MatrixXd outputs_nan = Eigen::MatrixXd::Zero(m, 2 * l + 1);
  UnscentedFilter part(Eigen::VectorXd::Zero(l), Eigen::MatrixXd::Identity(l, l)), whole = part;
  outputs_nan = h * whole.sigma_points();
  Eigen::VectorXd y_kept(4);
  Eigen::MatrixXd outputs_kept(4, 2 * l + 1);
  for (int i = 0; i < 4; ++i) {
    y_kept[i] = y[kept[static_cast<std::size_t>(i)]];
    outputs_kept.row(i) = outputs_nan.row(kept[static_cast<std::size_t>(i)]);
  }
  y[1] = std::numeric_limits<double>::quiet_NaN();
  outputs_nan(3, 2) = std::numeric_limits<double>::quiet_NaN();
  sigma[6] = std::numeric_limits<double>::infinity();
  const Noise four = Noise::independent(Eigen::VectorXd::Constant(4, 0.5));
  const FilterUpdate update = whole.update(y, outputs_nan, Noise::independent(sigma));
  const FilterUpdate expected = part.update(y_kept, outputs_kept, four);
  EXPECT_EQ(update.dof, 4);
  EXPECT_EQ(update.nis, expected.nis);
  EXPECT_EQ(whole.mean(), part.mean());
  EXPECT_EQ(whole.covariance(), part.covariance());
  EXPECT_TRUE(std::isnan(update.innovation[1]) && std::isnan(update.innovation[3]) && std::isnan(update.innovation[6]));
  EXPECT_EQ(update.innovation[5], expected.innovation[3]);

  const Eigen::MatrixXd before = whole.covariance();
  const Eigen::VectorXd nothing = Eigen::VectorXd::Constant(m, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(whole.update(nothing, Eigen::MatrixXd::Zero(m, 2 * l + 1), Noise::independent(sigma)).dof, 0);
  EXPECT_EQ(whole.covariance(), before);
}

TEST_F(UnscentedFilters, WrongInputIsRefused) {
  const Eigen::VectorXd mean = Eigen::VectorXd::Zero(2);
  EXPECT_THROW(UnscentedFilter(mean, Eigen::MatrixXd::Identity(3, 3)), std::invalid_argument);
  EXPECT_THROW(UnscentedFilter(mean, -Eigen::MatrixXd::Identity(2, 2)), NumericalError);
  EXPECT_THROW(Noise::independent(Eigen::VectorXd::Zero(2)), std::invalid_argument);
  EXPECT_THROW(Noise::correlated(-Eigen::MatrixXd::Identity(2, 2)), NumericalError);
  UnscentedFilter filter(mean, Eigen::MatrixXd::Identity(2, 2));
  const Noise noise = Noise::independent(Eigen::VectorXd::Ones(3));
  EXPECT_THROW(filter.update(Eigen::VectorXd::Zero(3), Eigen::MatrixXd::Zero(3, 4), noise), std::invalid_argument);
  EXPECT_THROW(filter.update(Eigen::VectorXd::Zero(2), Eigen::MatrixXd::Zero(2, 5), noise), std::invalid_argument);
  const auto diverging = [](const Eigen::MatrixXd& x) -> Eigen::MatrixXd { return x / 0.0; };
  EXPECT_THROW(filter.predict(diverging, Eigen::MatrixXd::Zero(2, 1)), NumericalError);
  EXPECT_EQ(filter.covariance(), Eigen::MatrixXd::Identity(2, 2));
}

/// Data drawn from the filter's own linear model: NIS and NEES stay inside their chi-squared bounds.
TEST_F(UnscentedFilters, NisAndNeesAreChiSquared) {
  const int l = 3, m = 5, steps = 40, seeds = 60;
  const Eigen::MatrixXd a = 0.9 * Eigen::MatrixXd::Identity(l, l), q_root = 0.2 * Eigen::MatrixXd::Identity(l, l);
  const Eigen::MatrixXd h = random(m, l);
  ConsistencySum nis, nees;
  for (int seed = 0; seed < seeds; ++seed) {
    const Eigen::VectorXd mean = Eigen::VectorXd::Zero(l);
    UnscentedFilter filter(mean, Eigen::MatrixXd::Identity(l, l));
    Eigen::VectorXd truth = random(l, 1);
    for (int step = 0; step < steps; ++step) {
      truth = a * truth + q_root * random(l, 1);
      const Eigen::VectorXd y = h * truth + 0.3 * random(m, 1);
      filter.predict([&](const Eigen::MatrixXd& x) -> Eigen::MatrixXd { return a * x; }, q_root);
      const FilterUpdate update =
          filter.update(y, h * filter.sigma_points(), Noise::independent(Eigen::VectorXd::Constant(m, 0.3)));
      nis.add(update.nis, update.dof);
    }
    nees.add(normalised_squared(truth - filter.mean(), filter.covariance()), l);
  }
  EXPECT_NEAR(nis.mean_per_dof(), 1.0, 0.05);
  EXPECT_GT(nis.p_value(), 0.01);
  EXPECT_GT(nees.p_value(), 0.01);
}

TEST_F(UnscentedFilters, ManyMeasurementsAreCheap) {
  const int l = 20, m = 2000;
  const Eigen::MatrixXd h = random(m, l);
  UnscentedFilter filter(Eigen::VectorXd::Zero(l), Eigen::MatrixXd::Identity(l, l));
  const Eigen::VectorXd truth = random(l, 1), y = h * truth + 0.1 * random(m, 1);
  const Noise noise = Noise::independent(Eigen::VectorXd::Constant(m, 0.1));
  const double start = processor_seconds();
  filter.update(y, h * filter.sigma_points(), noise);
  const double elapsed = processor_seconds() - start;
  RecordProperty("milliseconds", std::to_string(1e3 * elapsed));
  EXPECT_LT((filter.mean() - truth).norm(), 0.05);
  EXPECT_LT(elapsed, 0.5);  // a dense 2000 x 2000 covariance alone takes longer
}

}  // namespace
}  // namespace tissue_stiffness
