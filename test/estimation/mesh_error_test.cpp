// A coarse mesh is used on recordings from a fine one: the interval must carry what the mesh does.
#include "estimation/mesh_error.hpp"

#include <gtest/gtest.h>

#include "bar.hpp"
#include "forward/reduced_model.hpp"
#include "meshing/refine.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 30e3;

ModelSettings settings(bool studied) {
  ModelSettings out = box_settings(bar_under_gravity(prior(50e3, 3)));
  out.mesh.discretisation_error = studied;
  return out;
}

TetMesh coarse() {
  return bar_mesh(8, 2, 2);
}

// Films on a mesh three times as fine, seen at the coarse one's vertices.
std::vector<Frame> recording(int count) {
  const Experiment bar(settings(false), bar_mesh(24, 6, 6), {kTruth});
  std::mt19937 engine(1);
  return see_on(coarse(), corners(coarse()), bar, bar.film(0.0, kFilmed, count), kNoise, engine);
}

TEST(MeshError, OfACoarseMeshIsCorrectedAndInTheInterval) {
  const std::vector<Frame> frames = recording(40);
  Estimator plain(settings(false), coarse()), studied(settings(true), coarse());
  step_through(plain, frames);
  step_through(studied, frames);
  for (const Estimator* estimator : {&plain, &studied}) {
    const ParameterEstimate& p = estimator->estimate().parameters.front();
    std::printf("coarse mesh, %s: E %+.2f %% off, 95 %% %+.2f..%+.2f %%\n", estimator == &plain ? "plain" : "studied",
                100.0 * (p.mean / kTruth - 1.0), 100.0 * (p.lower95 / kTruth - 1.0), 100.0 * (p.upper95 / kTruth - 1.0));
  }
  EXPECT_FALSE(holds(plain.estimate().parameters.front(), kTruth));
  EXPECT_TRUE(holds(studied.estimate().parameters.front(), kTruth));
  EXPECT_LT(std::abs(value(studied) - kTruth), 0.5 * std::abs(value(plain) - kTruth));
}

TEST(MeshError, ChangesAreLeastAtTheShift) {
  const Model model(settings(true), coarse());
  const Eigen::VectorXd w = model.parameters().prior_mean(), none = Eigen::VectorXd::Zero(w.size());
  const MeshError::Question question(model, recording(20), w, 0.01 * model.parameters().prior_std(),
                                     model.parameters().prior_std());
  MeshError study(model);
  const Eigen::VectorXd shift = study.study(question).shift;
  const auto size = [&](const Eigen::VectorXd& at) {
    double square = 0.0;
    for (const Eigen::VectorXd& change : study.changes(question, at)) square += change.squaredNorm();
    return std::sqrt(square);
  };
  EXPECT_GT(size(shift), 0.0);
  EXPECT_LT(size(shift), 0.8 * size(none));
  EXPECT_LT(size(shift), size(1.3 * shift));
  EXPECT_LT(size(shift), size(0.7 * shift));
}

TEST(MeshError, IsInTheIntervalOfAShortRecordingToo) {
  Estimator studied(settings(true), coarse());
  step_through(studied, recording(5));
  const ParameterEstimate& p = studied.estimate().parameters.front();
  std::printf("five frames: E %+.2f %% off, 95 %% %+.2f..%+.2f %%\n", 100.0 * (p.mean / kTruth - 1.0),
              100.0 * (p.lower95 / kTruth - 1.0), 100.0 * (p.upper95 / kTruth - 1.0));
  EXPECT_TRUE(holds(p, kTruth));
  EXPECT_LT(p.upper95 / p.lower95, 1.2);
}

// A replay asks once, at the end, on a finer mesh that knows the parameters; a node asks again and again.
TEST(MeshError, IsTheSameOfAReplay) {
  std::vector<std::string> effects = bar_under_gravity(prior(50e3, 3));
  effects.push_back("stiff_inclusion: {center: [0.05, 0.01, 0.01], radius: 0.008, excess: {mean: 0.5, std: 0.5}}");
  for (const bool inclusion : {false, true}) {
    ModelSettings model = settings(true);
    if (inclusion) model = box_settings(effects);
    model.mesh.discretisation_error = true;
    const std::vector<Frame> frames = recording(40);
    Estimator stepped(model, coarse()), replayed(model, coarse());
    step_through(stepped, frames);
    replayed.replay(frames);
    const ParameterEstimate &a = stepped.estimate().parameters.front(), &b = replayed.estimate().parameters.front();
    std::printf("E %.1f Pa stepped, %.1f Pa replayed, +- %.1f\n", a.mean, b.mean, a.std);
    EXPECT_NEAR(a.mean, b.mean, 0.2 * a.std);
    EXPECT_NEAR(a.std, b.std, 0.2 * a.std);
  }
}

// Models of one body that are reused, at their own prior, save work and change nothing else.
TEST(MeshError, IsTheSameBesideRelatives) {
  const ModelSettings model = settings(true);
  const std::vector<Frame> frames = recording(40);
  const Model own(settings(false), coarse());
  const TetMesh refined = refined_mesh(own.mesh(), model.mesh);
  const Model fine(settings(false), refined, refine_regions(own.body().regions, own.mesh(), refined));
  BasisOptions keeping, beside = basis_beside(own.mesh(), refined);
  keeping.keep_root = beside.keep_root = true;
  const ReducedModel own_runs(own, keeping), fine_runs(fine, beside);
  Estimator alone(model, coarse()), related(model, coarse(), {&own_runs, &fine_runs});
  alone.replay(frames);
  related.replay(frames);
  const ParameterEstimate &a = alone.estimate().parameters.front(), &b = related.estimate().parameters.front();
  std::printf("E %.3f Pa alone, %.3f Pa beside relatives, +- %.1f\n", a.mean, b.mean, a.std);
  EXPECT_NEAR(a.mean, b.mean, 0.01 * a.std);
  EXPECT_NEAR(a.std, b.std, 0.01 * a.std);
}

// The load is so small that both laws describe one body.
TEST(MeshError, OfAFiniteStrainModelIsInTheInterval) {
  std::vector<std::string> effects = bar_under_gravity(prior(50e3, 3));
  effects[1] = "elasticity: {law: neo_hookean, poisson_ratio: 0.45, young_modulus: " + prior(50e3, 3) + "}";
  effects[3] = "gravity: {acceleration: [0.05, 0.1, -0.3]}";
  std::vector<std::string> linear = bar_under_gravity(prior(50e3, 3));
  linear[3] = effects[3];
  ModelSettings plain = box_settings(linear), finite = box_settings(effects);
  plain.mesh.discretisation_error = false;
  finite.mesh.discretisation_error = true;
  for (ModelSettings* s : {&plain, &finite}) s->observations.front().noise = 1e-5;
  const Experiment bar(plain, bar_mesh(24, 6, 6), {kTruth});
  std::mt19937 engine(1);
  const std::vector<Frame> frames = see_on(coarse(), corners(coarse()), bar, bar.film(0.0, kFilmed, 20), 1e-5, engine);
  Estimator estimator(finite, coarse());
  step_through(estimator, frames);
  const ParameterEstimate& p = estimator.estimate().parameters.front();
  std::printf("finite strain: E %+.2f %% off, 95 %% %+.2f..%+.2f %%\n", 100.0 * (p.mean / kTruth - 1.0),
              100.0 * (p.lower95 / kTruth - 1.0), 100.0 * (p.upper95 / kTruth - 1.0));
  EXPECT_TRUE(holds(p, kTruth));
  EXPECT_LT(p.upper95 / p.lower95, 2.0) << estimator.estimate().state_reason;  // despite a misfit of several sigma
  EXPECT_NE(estimator.description().back().find("linear form"), std::string::npos);
}

TEST(MeshError, IsSaidToBeAssessedOrNot) {
  EXPECT_NE(Estimator(settings(true), bar_mesh()).description().back().find("refined eightfold"), std::string::npos);
  EXPECT_NE(Estimator(settings(false), bar_mesh()).description().back().find("asks not to"), std::string::npos);
}

TEST(MeshError, IsNotAssessedWhereItWouldTakeTooMuch) {
  EXPECT_EQ(MeshError::why_not(bar_mesh()), "");
  TetMesh large;
  large.nodes.resize(3, 17001);
  EXPECT_EQ(MeshError::why_not(large), "the mesh has more than 17000 nodes");
}

TEST(MeshError, IsForgottenByAResetAndTheSameEveryTime) {
  const Experiment bar(settings(false), bar_mesh(), {kTruth});
  const std::vector<Frame> frames = see_all(bar, bar.film(0.0, kFilmed, 20), kNoise, 1);
  Estimator fresh(settings(true), bar_mesh()), used(settings(true), bar_mesh());
  step_through(used, frames);
  used.reset();
  EXPECT_TRUE(bytes(used) == bytes(fresh));
  step_through(used, frames);
  step_through(fresh, frames);
  EXPECT_TRUE(bytes(used) == bytes(fresh));
}

}  // namespace
}  // namespace tissue_stiffness
