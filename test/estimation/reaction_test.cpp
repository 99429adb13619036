// Displacement in, force out: what the force on a moved region says of the modulus.
#include <gtest/gtest.h>

#include <random>

#include "bar.hpp"
#include "felt_forces.hpp"
#include "forward/full_model.hpp"
#include "forward/load_error_response.hpp"
#include "forward/reduced_model.hpp"
#include "observation/observation_operator.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 24e3, kForceNoise = 2e-4;
const std::string kReaction = "{reaction: {topic: /force, region: tip, noise: 2.0e-4, gain: 0.02, bias: 1.0e-3}}";

std::vector<std::string> effects(const std::string& young_modulus) {
  return {"inertia: {density: 1000}", modulus(young_modulus), "fixed: {region: clamp}",
          "moved: {region: tip, topic: /pose, noise: 0}", "viscoelasticity: {gamma: 0.4, tau: 0.1}"};
}

// Along x and aslant: 2 mm and back again.
std::vector<LoadSample> poses(double interval = 0.005) {
  std::vector<LoadSample> out;
  for (double t = 0.0; t < 1.0; t += interval) {
    const double way = 0.001 * (1.0 - std::cos(2.0 * M_PI * t));
    const Eigen::Isometry3d pose = Eigen::Translation3d(way, 0.3 * way, 0.2) * Eigen::AngleAxisd::Identity();
    out.push_back({"/pose", t, pose_values(pose)});
  }
  return out;
}

std::vector<Frame> measured(const std::string& young_modulus = std::to_string(kTruth)) {
  Model model(box_settings(effects(young_modulus)), bar_mesh());
  model.loads().drive(0.0, poses(0.001));
  return felt_forces(model, 0.001, kFilmed, 45, kForceNoise);
}

StepResult estimated(Estimator& estimator, const std::vector<Frame>& frames) {
  estimator.set_first_stamp(0.0);
  for (const LoadSample& sample : poses()) estimator.add_load(sample);
  return step_through(estimator, frames);
}

TEST(Reaction, TheForceAloneTellsTheModulus) {
  const ModelSettings settings = box_settings(effects(prior(50e3, 3)), "[" + kReaction + "]");
  Estimator estimator(settings, bar_mesh());
  const StepResult last = estimated(estimator, measured());
  ASSERT_TRUE(last.used) << last.reason;
  const ParameterEstimate& e = estimator.estimate().parameters.at(0);
  std::printf("E %.1f (%.1f to %.1f) of %.1f\n", e.mean, e.lower95, e.upper95, kTruth);
  EXPECT_NEAR(e.mean, kTruth, 0.003 * kTruth);
  EXPECT_TRUE(holds(e, kTruth));
  EXPECT_LT(e.upper95 / e.lower95, 1.02);
  EXPECT_EQ(estimator.identifiability().at("elasticity.young_modulus").verdict, "absolute");
  EXPECT_EQ(last.misfit.count, 3);
  EXPECT_EQ(last.misfit.lengths, 0);  // a force says nothing in metres
}

// A force sensor of 2 % tells no modulus to 0.1 %, nor does a pose with a wrong gain.
TEST(Reaction, TheIntervalHoldsTheToleranceOfTheSensor) {
  ModelSettings settings = box_settings(effects(prior(50e3, 3)), "[" + kReaction + "]");
  settings.exact_inputs = false;
  Estimator estimator(settings, bar_mesh());
  std::vector<Frame> frames = measured();
  for (Frame& frame : frames) frame.observations.front().points *= 1.03;
  ASSERT_TRUE(estimated(estimator, frames).used);
  const ParameterEstimate& e = estimator.estimate().parameters.at(0);
  std::printf("E %.1f (%.1f to %.1f) of %.1f\n", e.mean, e.lower95, e.upper95, kTruth);
  EXPECT_NEAR(e.mean, 1.03 * kTruth, 0.01 * kTruth);
  EXPECT_TRUE(holds(e, kTruth));
  EXPECT_GT(e.upper95 / e.lower95, 1.06);
}

// A force sensor that is five times as noisy as stated, beside many points that are as stated: the whole hides it.
TEST(Reaction, ANoisyForceBesideManyPointsIsNotTakenAsStated) {
  const std::string both = "[{vertices: {topic: /vertices, noise: 1.0e-4}}, {reaction: {topic: /force, region: tip, " +
                           std::string("noise: 2.0e-4, gain: 0.001, bias: 1.0e-5}}]");
  ModelSettings settings = box_settings(effects(prior(50e3, 3)), both);
  settings.exact_inputs = false;
  const TetMesh mesh = bar_mesh();
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  std::vector<Frame> frames = measured();
  for (Frame& frame : frames) {
    frame.observations.front().source = 1;
    for (int i = 0; i < 3; ++i) frame.observations.front().points(i, 0) += 1e-3 * normal(random);
    const double way = 0.001 * (1.0 - std::cos(2.0 * M_PI * frame.time));
    Observation seen;  // the held end and the one that follows: they say nothing of E
    seen.time = frame.time;
    std::vector<int> ends;
    for (int v = 0; v < mesh.corner_count; ++v) {
      if (mesh.nodes(0, v) < 1e-6 || mesh.nodes(0, v) > 0.099999) ends.push_back(v);
    }
    seen.ids = Eigen::Map<Eigen::VectorXi>(ends.data(), static_cast<Eigen::Index>(ends.size()));
    seen.points.resize(3, seen.ids.size());
    for (Eigen::Index i = 0; i < seen.ids.size(); ++i) {
      const Eigen::Vector3d x = mesh.nodes.col(seen.ids[i]);
      seen.points.col(i) = x + (x[0] > 0.05 ? Eigen::Vector3d(way, 0.3 * way, 0.0) : Eigen::Vector3d::Zero());
      for (int k = 0; k < 3; ++k) seen.points(k, i) += 1e-4 * normal(random);
    }
    frame.observations.insert(frame.observations.begin(), seen);
  }
  Estimator estimator(settings, mesh);
  ASSERT_TRUE(estimated(estimator, frames).used);
  const ParameterEstimate& e = estimator.estimate().parameters.at(0);
  std::printf("E %.1f (%.1f to %.1f) of %.1f\n", e.mean, e.lower95, e.upper95, kTruth);
  EXPECT_TRUE(holds(e, kTruth));
  // 135 rows of about 0.1 N tell E to 0.1 %; three times as much is what the noise deserves.
  EXPECT_GT(e.upper95 / e.lower95, 1.002);
}

TEST(Reaction, ARegionThatNothingMovesIsRefused) {
  const std::string message = refusal([] {
    const Model model(box_settings({"inertia: {density: 1000}", modulus("3e4"), "fixed: {region: clamp}"},
                                   "[{reaction: {topic: /force, region: tip, noise: 1}}]"),
                      bar_mesh(2));
    make_observation_operators(model);
  });
  EXPECT_NE(message.find("tip"), std::string::npos) << message;
  EXPECT_NE(message.find("moved"), std::string::npos) << message;
}

// Without a force the moduli of two halves are known as a ratio only.
TEST(Reaction, WithoutAForceOnlyTheRatioIsKnown) {
  const auto halves = [](const std::string& near, const std::string& far) {
    return std::vector<std::string>{"inertia: {density: 1}", modulus(near, "near"), modulus(far, "far"),
                                    "fixed: {region: clamp}", "moved: {region: tip, topic: /pose}"};
  };
  Model model(box_settings(halves("2.4e4", "4.8e4")), bar_mesh());
  model.loads().drive(0.0, poses());
  FullModel::Options options;
  options.step = 0.001;
  const FullModel full(model, options);
  const auto run = full.start(model.parameters().theta(Eigen::VectorXd(0)), 0.0);
  std::vector<Frame> frames;
  for (int k = 1; k <= 45; ++k) {
    run->advance(kFilmed * k);
    const Eigen::VectorXd u = run->displacement();
    Observation seen;
    seen.time = kFilmed * k;
    seen.ids = Eigen::VectorXi::LinSpaced(model.mesh().corner_count, 0, model.mesh().corner_count - 1);
    seen.points = (model.mesh().nodes + Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, model.mesh().node_count()))
                      .leftCols(model.mesh().corner_count);
    frames.push_back({seen.time, {seen}});
  }
  Estimator estimator(box_settings(halves(prior(50e3, 3), prior(50e3, 3))), bar_mesh());
  ASSERT_TRUE(estimated(estimator, frames).used);
  EXPECT_NEAR(value(estimator, 1) / value(estimator, 0), 2.0, 0.1);  // the noise leaves 2 %
  EXPECT_EQ(estimator.identifiability().at("elasticity.young_modulus").verdict, "ratio_only");
  EXPECT_EQ(estimator.identifiability().at("elasticity#2.young_modulus").verdict, "ratio_only");
}

// What an error of the pose adds to the force, against two runs: gain, delay, and hats of the slow noise.
TEST(Reaction, TheResponseToAnErrorOfThePoseIsThatOfARun) {
  Model model(box_settings({"inertia: {density: 1000}", modulus("9e3"), "fixed: {region: clamp}",
                            "moved: {region: tip, topic: /pose}", "viscous_damping: {beta: 0.01}"}),
              bar_mesh());
  model.loads().drive(0.0, poses());
  const ReducedModel reduced(model);
  const Eigen::VectorXd theta = model.parameters().theta(Eigen::VectorXd(0));
  const auto course = model.loads().courses().at("/pose");
  const auto measured = [&](double t) {
    return Eigen::VectorXd(Eigen::Vector3d(course->measured(t, 0), course->measured(t, 1), course->measured(t, 2)));
  };
  const LoadErrorBasis basis(course->tolerance(), measured, 3, 0.0, 0.9);
  ASSERT_EQ(basis.groups().front().name, "gain");
  const ReactionRows rows = reduced.reaction_rows(theta, *reduced.modes(theta));
  const auto forces = [&] {
    const auto run = reduced.start(theta, 0.0);
    Eigen::MatrixXd out(3, 40);
    for (int k = 0; k < 40; ++k) {
      run->advance(kFilmed * (k + 1));
      out.col(k) = run->output().tail<3>();
    }
    return out;
  };
  const Eigen::MatrixXd without = forces();
  for (const int column : {0, 1, 5, 6, 12}) {
    LoadErrorResponse response(reduced, theta, 0.0, course, basis);
    Eigen::MatrixXd expected(3, 40);
    for (int k = 0; k < 40; ++k) {
      response.advance(kFilmed * (k + 1));
      expected.col(k) =
          rows.elastic.transpose() * response.amplitudes().col(column) + response.further_reactions().col(column);
    }
    course->correct(basis, Eigen::VectorXd::Unit(basis.size(), column));
    const Eigen::MatrixXd found = without - forces();
    course->correct({}, {});
    std::printf("column %d: %.2e apart of %.2e N\n", column, (found - expected).norm(), expected.norm());
    EXPECT_GT(expected.norm(), 1e-5) << column;
    EXPECT_LT((found - expected).norm(), 0.15 * expected.norm()) << column;
  }
}

}  // namespace
}  // namespace tissue_stiffness
