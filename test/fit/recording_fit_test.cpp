// A model's free run against a recording.
#include "fit/recording_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../estimation/bar.hpp"
#include "fit/nested_parameters.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kFrames = 36;
constexpr double kTruth = 30e3;

class RecordingFitTest : public ::testing::Test {
 protected:
  static Recording film(const std::vector<std::string>& more, double noise) {
    std::vector<std::string> effects = bar_under_gravity(prior(kTruth, 2.0));
    effects.insert(effects.end(), more.begin(), more.end());
    const Experiment truth(box_settings(effects), bar_mesh(), {kTruth});
    Recording recording;
    recording.frames = see_all(truth, truth.film(0.0, kFilmed, kFrames), noise, 5);
    return recording;
  }
  static ModelSettings model(const std::vector<std::string>& more = {}) {
    std::vector<std::string> effects = bar_under_gravity(prior(40e3, 3.0));
    effects.insert(effects.end(), more.begin(), more.end());
    return box_settings(effects);
  }
  static Eigen::VectorXd at(double young_modulus) { return Eigen::VectorXd::Constant(1, std::log(young_modulus)); }
};

TEST_F(RecordingFitTest, HasRowsOfTheNoiseAtTheTruth) {
  const Recording recording = film({}, kNoise);
  const RecordingFit fit(model(), bar_mesh(), recording);
  const RecordingRows rows = fit.rows(at(kTruth));
  EXPECT_EQ(rows.frames.count(), kFrames);
  EXPECT_EQ(rows.frames.total(), rows.error.size());
  EXPECT_EQ(rows.count(), static_cast<double>(rows.error.size()));
  EXPECT_NEAR(rms_error(rows) / kNoise, 1.0, 0.05);
  EXPECT_NEAR(noise_floor(rows) / kNoise, 1.0, 1e-12);
  EXPECT_TRUE(fit.predicted(at(kTruth)).isApprox(rows.predicted, 1e-12));
  EXPECT_GT(rms_error(fit.rows(at(2.0 * kTruth))), 5.0 * kNoise);
}

// The rows along a displacement are what the rows change by when the body moves by it.
TEST_F(RecordingFitTest, HasRowsAlongADisplacement) {
  const Recording recording = film({}, kNoise);
  const RecordingFit fit(model(), bar_mesh(), recording);
  const RecordingRows rows = fit.rows(at(kTruth));
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(3 * bar_mesh().node_count(), 2);
  for (Eigen::Index i = 0; i < shapes.rows(); i += 3) shapes(i, 0) = 1.0;
  shapes.col(1).setConstant(-2.0);
  const Eigen::MatrixXd along = fit.rows_along(at(kTruth), shapes, rows);
  for (Eigen::Index r = 0; r < along.rows(); ++r) {
    ASSERT_NEAR(std::abs(along(r, 0)) * kNoise, r % 3 == 0 ? rows.used[r] : 0.0, 1e-9) << r;
    ASSERT_NEAR(std::abs(along(r, 1)) * kNoise, 2.0 * rows.used[r], 1e-9) << r;
  }
}

// The motion is linear in an acceleration of the body, so one solve finds it at any modulus.
TEST_F(RecordingFitTest, SolvesForWhatActsOnTheBody) {
  const Recording recording = film({"gravity: {acceleration: [0.5, 0, -0.3]}"}, 0.01 * kNoise);
  const RecordingFit fit(model({"gravity: {acceleration: {mean: [0, 0, 0], std: 2}}"}), bar_mesh(), recording);
  const std::vector<Eigen::Index> acting = NestedParameters(fit, fit).acting();
  ASSERT_EQ(acting, (std::vector<Eigen::Index>{1, 2, 3}));
  ASSERT_EQ(NestedParameters(fit, fit).tuning(), std::vector<Eigen::Index>{0});
  const auto start = [](double young_modulus) { return Eigen::Vector4d(std::log(young_modulus), 0.0, 0.0, 0.0); };
  const RecordingFit::Place found = fit.project({start(kTruth)}, acting, 1.0);
  EXPECT_LT((found.w - start(kTruth) - Eigen::Vector4d(0.0, 0.5, 0.0, -0.3)).cwiseAbs().maxCoeff(), 0.02);
  const RecordingFit::Place best = fit.project({start(1.02 * kTruth)}, acting, 0.5);
  EXPECT_EQ(best.w[0], std::log(1.02 * kTruth));
  EXPECT_NEAR(fit.scan_near(best.w, {}, 0.5).cost, best.cost, 1e-9 * best.cost);
  for (const Eigen::Index i : acting) {
    for (const double step : {-0.5, 0.5})
      EXPECT_GT(fit.scan_near(best.w + step * Eigen::Vector4d::Unit(i), {}, 0.5).cost, best.cost) << i;
  }
}

// Without its weight the bar would not move, so the modulus alone does not fit better anywhere.
TEST_F(RecordingFitTest, SolvesForWhatActsOnTheBodyWhereverItScans) {
  const Recording recording = film({"gravity: {acceleration: [0, 3, 9.81]}"}, 0.01 * kNoise);
  const RecordingFit fit(model({"gravity: {acceleration: {mean: [0, 0, 0], std: 10}}"}), bar_mesh(), recording);
  const Eigen::Vector4d start(std::log(3.0 * kTruth), 0.0, 0.0, 0.0);
  const RecordingFit::Place found = fit.scan_prior(start, {0}, {1, 2, 3}, 0.5);
  EXPECT_NEAR(found.w[0], std::log(kTruth), 0.03);
  EXPECT_NEAR(found.w[2], 3.0, 0.2);
  EXPECT_NEAR(found.w[3], 9.81, 0.4);
  EXPECT_NEAR(fit.scan_near(found.w, {}, 0.5).cost, found.cost, 1e-9 * found.cost);
  const RecordingFit::Place held = fit.scan_prior(fit.project({start}, {1, 2, 3}, 0.5).w, {0}, {}, 0.5);
  EXPECT_LT(found.cost, 0.5 * held.cost);
}

// Minima of a ringing body lie along what shifts its frequencies. One such parameter is scanned, and what shifts none.
TEST_F(RecordingFitTest, ScansWhatShiftsTheFrequenciesMost) {
  const Recording recording = film({}, kNoise);
  const auto scanned = [&](double modulus_factor, const std::string& mass_factor) {
    std::vector<std::string> effects = bar_under_gravity(prior(kTruth, modulus_factor));
    effects.push_back("added_mass: {region: tip, mass: {prior: 0.02, factor: " + mass_factor + "}}");
    effects.emplace_back("mass_damping: {alpha: {prior: 2, factor: 2}}");
    const RecordingFit fit(box_settings(effects), bar_mesh(), recording);
    EXPECT_EQ(NestedParameters(fit, fit).tuning(), (std::vector<Eigen::Index>{0, 1, 2}));
    return NestedParameters(fit, fit).scanned();
  };
  EXPECT_EQ(scanned(3.0, "1.1"), (std::vector<Eigen::Index>{0, 2}));
  EXPECT_EQ(scanned(1.1, "9"), (std::vector<Eigen::Index>{1, 2}));
}

TEST_F(RecordingFitTest, FindsTheModulusByFitAndByScan) {
  const Recording recording = film({}, kNoise);
  RecordingFit fit(model(), bar_mesh(), recording);
  const Eigen::VectorXd start = fit.scan(fit.model().parameters().prior_mean());
  EXPECT_NEAR(start[0], std::log(kTruth), 0.3);
  EXPECT_NEAR(fit.scan_prior(at(60e3), {0}, {}, 1.0).w[0], std::log(kTruth), 0.3);
  const RecordingFit::Place near = fit.scan_near(at(1.05 * kTruth), {0});
  EXPECT_NEAR(near.w[0], std::log(kTruth), 0.03);
  const double rows = 3.0 * static_cast<double>(recording.training().size() * corners(bar_mesh()).size());
  EXPECT_NEAR(near.cost / rows, 1.0, 0.2);
  EXPECT_NEAR(fit.scan_near(at(1.05 * kTruth), {0}, 0.5).cost / rows, 0.5, 0.1);
  const Eigen::VectorXd spread = 0.1 * fit.model().parameters().prior_std();
  EXPECT_NEAR(fit.fit(start, spread).w[0], std::log(kTruth), 0.01);
  const BatchFit whole = fit.quick_fit(start, spread), part = fit.quick_fit(start, spread, 0.25);
  EXPECT_GT(part.covariance(0, 0), 1.5 * whole.covariance(0, 0)) << "a part of the frames knows less";
}

TEST_F(RecordingFitTest, KeepsWhatTwoModelsShare) {
  const Recording recording = film({}, kNoise);
  const RecordingFit base(model(), bar_mesh(), recording);
  const RecordingFit more(model({"viscous_damping: {beta: {prior: 1.0e-3, factor: 2}}"}), base);
  EXPECT_EQ(more.index("elasticity.young_modulus"), 0);
  EXPECT_EQ(base.index("viscous_damping.beta"), -1);
  EXPECT_EQ(NestedParameters(more, base).all(), std::vector<Eigen::Index>{0});
  EXPECT_EQ(NestedParameters(more, base).tuning(), std::vector<Eigen::Index>{0});
  const Eigen::VectorXd w = NestedParameters(more, base).extend(at(22e3)), prior = more.model().parameters().prior_mean();
  EXPECT_EQ(w[0], std::log(22e3));
  EXPECT_EQ(w[1], prior[1]);
  const Eigen::VectorXd ratio = NestedParameters(more, base).spread().cwiseQuotient(more.model().parameters().prior_std());
  EXPECT_NEAR(ratio[0], 0.05, 1e-12);
  EXPECT_NEAR(ratio[1], 0.25, 1e-12);
}

// Under finite strain few runs in full lead to the modulus: quick runs are corrected from one to the next.
TEST_F(RecordingFitTest, FindsTheModulusUnderFiniteStrain) {
  const std::vector<std::string> large{"geometric_nonlinearity: {share: 1}", "mass_damping: {alpha: 2}"};
  const Recording recording = film(large, 1e-6);
  RecordingFit fit(model(large), bar_mesh(), recording);
  const double linear = RecordingFit(model({"mass_damping: {alpha: 2}"}), bar_mesh(), recording)
                            .fit(at(40e3), Eigen::VectorXd::Constant(1, 0.05))
                            .w[0];
  ASSERT_GT(std::abs(linear - std::log(kTruth)), 1e-3) << "a linear model is off";
  const BatchFit found = fit.fit(at(40e3), Eigen::VectorXd::Constant(1, 0.05));
  std::printf("off by %.2e, the linear model by %.2e\n", found.w[0] - std::log(kTruth), linear - std::log(kTruth));
  EXPECT_NEAR(found.w[0], std::log(kTruth), 2e-5);
  EXPECT_LT(rms_error(fit.rows(found.w)), 2e-6) << "quick runs agree with the last one in full";
  RecordingFit wider(model({large[0], large[1], "viscous_damping: {beta: {prior: 1.0e-4, factor: 2}}"}), fit);
  wider.borrow(fit);
  Eigen::VectorXd w = NestedParameters(wider, fit).extend(found.w);
  EXPECT_TRUE(wider.rows(w).predicted.allFinite());
}

}  // namespace
}  // namespace tissue_stiffness
