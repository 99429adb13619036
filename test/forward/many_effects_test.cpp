// One model that holds every linear proposal at its absent value: what a search for missing physics differentiates.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>

#include "../box_model.hpp"
#include "effects/registry.hpp"
#include "forward/full_model.hpp"
#include "forward/reduced_model.hpp"
#include "forward/reduced_trajectory.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"

namespace tissue_stiffness {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// As a model file has them.
std::vector<std::string> linear_proposals(const Model& base, const std::vector<std::string>& effects) {
  const ProposalContext context{base.settings(), base.mesh(), base.body().regions, 3e4, 0.45, 1000.0, 0.02, 0.4};
  std::vector<std::string> list;
  for (const EffectSpec& spec : effect_specs()) {
    if (!spec.proposals) continue;
    for (const Proposal& proposal : spec.proposals(context)) {
      std::vector<std::string> all = effects;
      all.push_back(to_yaml(proposal.entry));
      static const TetMesh small = bar_mesh(1);
      if (!Model(box_settings(all), small).nonlinear()) list.push_back(all.back());
    }
  }
  return list;
}

// Displacement at two instants, one column each.
Eigen::MatrixXd run(const ForwardModel& forward, const Eigen::VectorXd& theta) {
  const auto trajectory = forward.start(theta, 0.0);
  Eigen::MatrixXd u;
  for (const double time : {0.1, 0.2}) {
    trajectory->advance(time);
    u.conservativeResize(trajectory->displacement().size(), u.cols() + 1);
    u.rightCols<1>() = trajectory->displacement();
  }
  return u;
}

const std::vector<std::string> kBase{
    "inertia: {density: 1000}", "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: {prior: 3.0e4, factor: 2}}",
    "fixed: {region: clamp}", "gravity: {acceleration: [0.5, 1, -2]}"};

TEST(ManyEffects, TangentsOfTheReducedModelAreThoseOfTheFullOne) {
  const TetMesh mesh = bar_mesh(4);
  const Model base(box_settings(kBase), mesh);
  std::vector<std::string> effects = kBase;
  for (const std::string& proposal : linear_proposals(base, kBase)) effects.push_back(proposal);
  Model model(box_settings(effects), mesh);
  const ReducedModel reduced(model);
  FullModel::Options options;
  options.step = 5e-4;
  options.spectral_radius = 1.0;
  const FullModel full(model, options);
  const Eigen::VectorXd w = model.parameters().prior_mean(), std = model.parameters().prior_std();
  const Eigen::MatrixXd a0 = run(reduced, model.parameters().theta(w)), b0 = run(full, model.parameters().theta(w));
  EXPECT_LT((a0 - b0).norm(), 1e-3 * b0.norm());
  std::string previous;
  for (Eigen::Index i = 1; i < w.size(); ++i) {
    const std::string& name = model.parameters().free()[static_cast<std::size_t>(i)].name;
    const std::string effect = name.substr(0, name.find_first_of("#."));
    if (effect == previous && i % 7 != 0) continue;  // some of each
    previous = effect;
    const Eigen::VectorXd step = 0.02 * std[i] * Eigen::VectorXd::Unit(w.size(), i);
    const Eigen::MatrixXd a = run(reduced, model.parameters().theta(w + step)) - a0,
                          b = run(full, model.parameters().theta(w + step)) - b0;
    const std::vector<std::string> sensors{"image_scale", "rigid_drift", "sensor_rotation", "time_offset"};
    if (std::find(sensors.begin(), sensors.end(), effect) != sensors.end()) {  // they leave the body alone
      EXPECT_TRUE(a.isZero(0.0)) << name;
      continue;
    }
    if (b.isZero(0.0)) {  // it begins with the run's end
      EXPECT_LT(a.norm(), 1e-3 * a0.norm()) << name;
      continue;
    }
    const double error = (a - b).norm() / b.norm();
    std::printf("tangent of %s: %.1e off\n", name.c_str(), error);
    EXPECT_LT(error, 0.25) << name;
  }
}

// Wall times on a mesh of the size of a real case.
TEST(ManyEffects, AreProjectedInSeconds) {
  const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 22, 4, 4, 2);
  const Model base(box_settings(kBase), mesh);
  std::vector<std::string> effects = kBase;
  for (const std::string& proposal : linear_proposals(base, kBase)) effects.push_back(proposal);
  auto start = Clock::now();
  Model model(box_settings(effects), mesh);
  const double build = since(start);
  start = Clock::now();
  const ReducedModel reduced(model);
  const double reduce = since(start);
  start = Clock::now();
  const Eigen::VectorXd w = model.parameters().prior_mean();
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    ReducedTrajectory trajectory(reduced, model.parameters().theta(w + 0.01 * Eigen::VectorXd::Unit(w.size(), i)), 0.0);
    for (int k = 1; k <= 100; ++k) trajectory.advance(0.02 * k);
    EXPECT_TRUE(trajectory.coordinates().allFinite());
  }
  std::printf("%zu effects, %d nodes: model %.2f s, %s %.2f s, %d tangents over 100 frames %.2f s\n", effects.size(),
              mesh.node_count(), build, reduced.description().c_str(), reduce, static_cast<int>(w.size()), since(start));
  EXPECT_LE(reduced.basis().cols(), 220);
}

}  // namespace
}  // namespace tissue_stiffness
