// The fitted parameters compensate each other: how stiff a ball in a bar is, how large, and how stiff the bar around it is.
#include "fit/batch_fit.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <random>

#include "../estimation/bar.hpp"
#include "forward/reduced_model.hpp"
#include "observation/observation_operator.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kFrames = 60;
constexpr double kModulus = 30e3;

struct Ball {
  Eigen::Vector3d center;
  double radius, excess;
};

std::string text(const Eigen::Vector3d& x) {
  return "[" + std::to_string(x[0]) + ", " + std::to_string(x[1]) + ", " + std::to_string(x[2]) + "]";
}

ModelSettings bar_with_ball(const std::string& young_modulus, const std::string& ball) {
  std::vector<std::string> effects = bar_under_gravity(young_modulus);
  effects.push_back("stiff_inclusion: " + ball);
  return box_settings(effects);
}

ModelSettings model_of(const Ball& ball) {
  return bar_with_ball(prior(25e3, 3.0), "{center: {mean: " + text(ball.center) +
                                             ", std: 0.008}, radius: " + prior(ball.radius, 1.5) +
                                             ", excess: {mean: " + std::to_string(ball.excess) + ", std: 3}}");
}

// Scans the modulus first, as the diagnosis does before it fits.
Eigen::VectorXd with_best_modulus(const FitProblem& problem) {
  Eigen::VectorXd best = problem.model.parameters().prior_mean();
  double lowest = std::numeric_limits<double>::infinity();
  for (double off = -0.4; off < 0.4; off += 0.01) {
    Eigen::VectorXd w = problem.model.parameters().prior_mean();
    w[0] = std::log(kModulus) + off;
    const double cost = free_fit(problem, w).cost;
    if (cost < lowest) lowest = cost, best = w;
  }
  return best;
}

TEST(BatchFit, FollowsValleysOfParametersThatMakeUpForOneAnother) {
  const TetMesh mesh = bar_mesh(8, 2, 2);
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0), either(-1.0, 1.0);
  for (int draw = 0; draw < 6; ++draw) {
    Ball ball{{0.02 + 0.06 * uniform(engine), 0.02 * uniform(engine), 0.02 * uniform(engine)},
              0.007 + 0.007 * uniform(engine),
              0.5 + 2.0 * uniform(engine)};
    const Experiment truth(
        bar_with_ball(prior(kModulus, 2.0), "{center: " + text(ball.center) + ", radius: " + std::to_string(ball.radius) +
                                                ", excess: " + std::to_string(ball.excess) + "}"),
        mesh, {kModulus});
    const std::vector<Frame> frames = see_all(truth, truth.film(0.0, kFilmed, kFrames), kNoise, 3);

    for (int axis = 0; axis < 3; ++axis) ball.center[axis] += 0.004 * either(engine);
    ball.radius *= std::exp(0.3 * either(engine));
    ball.excess *= 1.0 + 0.5 * either(engine);
    const Model model(model_of(ball), mesh);
    const ReducedModel runs(model);
    const auto operators = make_observation_operators(model);
    const FitProblem problem{model, runs, operators, frames, 0.0};
    const Eigen::VectorXd start = with_best_modulus(problem);
    const BatchFit fit = fit_batch(problem, start, 0.02 * model.parameters().prior_std());
    const FreeFit left = free_fit(problem, fit.w);
    EXPECT_LT(left.cost, 1.05 * left.rows) << "ball " << draw << ", from " << free_fit(problem, start).cost;
  }
}

// The bar stands on a foundation that its model lacks. The modulus that compensates for it is far off, and errors stay
// large.
class WithoutItsFoundation : public ::testing::Test {
 protected:
  struct Fit {
    BatchFit fit;
    int runs;
  };
  Fit fit(double off, double rival) const {
    int frames = 0;
    FitProblem problem{model_, runs_, operators_, frames_, RunStart{}};
    problem.checkpoint = [&] { ++frames; };
    const Eigen::VectorXd start = model_.parameters().prior_mean() + Eigen::VectorXd::Constant(1, off);
    const BatchFit fit = fit_batch(problem, start, 0.1 * model_.parameters().prior_std(), rival);
    return {fit, frames / kFrames};
  }
  static std::vector<std::string> supported() {
    std::vector<std::string> effects = bar_under_gravity(prior(kModulus, 2.0));
    effects.push_back("foundation: {region: top, stiffness: 3.0e4}");
    return effects;
  }

  const TetMesh mesh_ = bar_mesh(8, 2, 2);
  const Experiment truth_{box_settings(supported()), mesh_, {kModulus}};
  const std::vector<Frame> frames_ = see_all(truth_, truth_.film(0.0, kFilmed, kFrames), kNoise, 3);
  const Model model_{box_settings(bar_under_gravity(prior(kModulus, 3.0))), mesh_};
  const ReducedModel runs_{model_};
  const std::vector<std::unique_ptr<ObservationOperator>> operators_ = make_observation_operators(model_);
};

// Plain Gauss-Newton steps shrink before they arrive: 25 of them leave a cost of 4.0 to 4.6 million.
TEST_F(WithoutItsFoundation, ExtrapolatesStepsThatShrinkSlowly) {
  for (const double off : {-0.3, -0.1, 0.03, 0.1, 0.3}) {
    const Fit found = fit(off, no_rival);
    std::printf("from %+.2f: %d runs, cost %.0f\n", off, found.runs, found.fit.cost);
    EXPECT_LT(found.fit.cost, 1e6);
  }
}

TEST_F(WithoutItsFoundation, EndsEarlyBesideARivalOutOfReach) {
  const Fit alone = fit(0.1, no_rival);
  const Fit near = fit(0.1, alone.fit.cost), hopeless = fit(0.1, -100.0 * alone.fit.cost);
  EXPECT_EQ(near.fit.w, alone.fit.w);
  EXPECT_EQ(near.runs, alone.runs);
  EXPECT_LT(hopeless.runs, alone.runs / 2);
  EXPECT_GT(hopeless.fit.cost, alone.fit.cost);
}

}  // namespace
}  // namespace tissue_stiffness
