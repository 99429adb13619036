// The error of the reduced basis is reported, bounds the real one, and is small because the basis grows.
#include "estimation/basis_error.hpp"

#include <gtest/gtest.h>

#include "bar.hpp"
#include "fit/batch_fit.hpp"
#include "forward/full_model.hpp"
#include "meshing/surface.hpp"
#include "observation/observation_operator.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kFrames = 40;

class BasisErrorOfABar : public testing::Test {
 protected:
  BasisErrorOfABar()
      : settings_(box_settings(bar_under_gravity(prior(30e3, 2.0)))),
        mesh_(bar_mesh(6, 2, 2)),
        model_(settings_, mesh_),
        operators_(make_observation_operators(model_)) {
    const Experiment truth(settings_, mesh_, {30e3});
    frames_ = see_all(truth, truth.film(0.0, kFilmed, kFrames), kNoise, 3);
  }

  ReducedModel reduced(int size) const {
    BasisOptions options;
    options.size = size;
    return ReducedModel(model_, options);
  }

  BasisError reported(const ReducedModel& model) const {
    return basis_error(model, {model_, model, operators_, frames_, 0.0}, model_.parameters().prior_mean(),
                       surface_nodes(mesh_));
  }

  // Compares with a basis so large that nothing is missing from it.
  double real(const ReducedModel& model) const {
    const ReducedModel full = reduced(200);
    const Eigen::VectorXd theta = model_.parameters().theta(model_.parameters().prior_mean());
    const auto a = model.start(theta, 0.0), b = full.start(theta, 0.0);
    double worst = 0.0;
    for (const Frame& frame : frames_) {
      a->advance(frame.time);
      b->advance(frame.time);
      const Eigen::VectorXd off = (a->displacement() - b->displacement()).head(3 * mesh_.corner_count);
      worst = std::max(worst, std::sqrt(off.squaredNorm() / static_cast<double>(off.size())));
    }
    return worst;
  }

  ModelSettings settings_;
  TetMesh mesh_;
  Model model_;
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
  std::vector<Frame> frames_;
};

TEST_F(BasisErrorOfABar, BoundsTheRealErrorWithinAFactorOfTwenty) {
  for (const int size : {4, 6, 10, 16, 24, 48}) {
    const ReducedModel model = reduced(size);
    const double told = reported(model).rms, truth = real(model);
    EXPECT_GE(told, truth) << size << " vectors";
    EXPECT_LE(told, 20.0 * truth) << size << " vectors";
  }
}

TEST_F(BasisErrorOfABar, TellsWhatItDoesToTheModulus) {
  const auto fitted = [&](const ReducedModel& model) {
    return fit_batch({model_, model, operators_, frames_, 0.0}, model_.parameters().prior_mean(),
                     0.05 * model_.parameters().prior_std());
  };
  const double best = fitted(reduced(200)).w[0];
  for (const int size : {4, 6, 10}) {
    const ReducedModel model = reduced(size);
    const BatchFit fit = fitted(model);
    const Eigen::VectorXd spread = 2.0 * fit.covariance.diagonal().cwiseSqrt();
    const double told =
        basis_shift(model, {model_, model, operators_, frames_, 0.0}, fit.w, spread, model_.parameters().prior_std())
            .cwiseAbs()[0];
    const double truth = std::abs(fit.w[0] - best);
    EXPECT_GE(2.0 * told, truth) << size << " vectors";
    EXPECT_LE(told, 60.0 * truth + 2.0 * std::sqrt(fit.covariance(0, 0))) << size << " vectors";
  }
}

TEST_F(BasisErrorOfABar, AgreesWithTheFullModel) {
  FullModel::Options fine;
  fine.step = 2e-4;
  fine.spectral_radius = 1.0;
  const ReducedModel model = reduced(24);
  const Eigen::VectorXd theta = model_.parameters().theta(model_.parameters().prior_mean());
  const auto a = model.start(theta, 0.0), b = FullModel(model_, fine).start(theta, 0.0);
  double worst = 0.0, motion = 0.0;
  for (int k = 1; k <= 10; ++k) {
    a->advance(kFilmed * k);
    b->advance(kFilmed * k);
    worst = std::max(worst, (a->displacement() - b->displacement()).cwiseAbs().maxCoeff());
    motion = std::max(motion, b->displacement().cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 2e-3 * motion);
}

TEST_F(BasisErrorOfABar, MakesACrippledBasisGrow) {
  const ReducedModel crippled = reduced(2);
  ASSERT_GT(reported(crippled).sigmas, 0.1) << "two vectors are enough here";
  std::unique_ptr<ReducedModel> model = crippled.grown();
  for (int k = 0; k < 12 && model && reported(*model).sigmas > 0.1; ++k) model = model->grown();
  ASSERT_TRUE(model);
  EXPECT_GT(model->basis().cols(), crippled.basis().cols());
  EXPECT_LE(reported(*model).sigmas, 0.1);
  EXPECT_LT(real(*model), 0.1 * kNoise);
}

TEST_F(BasisErrorOfABar, IsReportedByTheEstimatorBelowATenthOfTheNoise) {
  Estimator estimator(settings_, mesh_);
  EXPECT_FALSE(estimator.basis_error());
  step_through(estimator, frames_);
  ASSERT_TRUE(estimator.basis_error());
  EXPECT_GT(*estimator.basis_error(), 0.0);
  EXPECT_LE(*estimator.basis_error(), 0.1 * kNoise);
  estimator.reset();
  EXPECT_FALSE(estimator.basis_error());
}

}  // namespace
}  // namespace tissue_stiffness
