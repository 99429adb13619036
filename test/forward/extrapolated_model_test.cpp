#include "forward/extrapolated_model.hpp"

#include <gtest/gtest.h>

#include "../box_model.hpp"
#include "forward/reduced_basis.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kFrames = 20;
constexpr double kFrame = 0.02;  // s

std::vector<std::string> swinging(const std::vector<std::string>& more = {}) {
  std::vector<std::string> out{
      "inertia: {density: 1000}", "elasticity: {law: neo_hookean, poisson_ratio: 0.45, young_modulus: 400e3}",
      "fixed: {region: clamp}", "gravity: {acceleration: [5, 10, -30]}", "viscous_damping: {beta: 1e-3}"};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

Eigen::MatrixXd motion(const ForwardModel& forward, const Model& model) {
  const auto run = forward.start(model.parameters().theta(model.parameters().prior_mean()), 0.0);
  Eigen::MatrixXd out(model.fem().dof_count(), kFrames);
  for (int k = 0; k < kFrames; ++k) {
    run->advance((k + 1) * kFrame);
    out.col(k) = run->displacement();
  }
  return out;
}

FullModel::Options steps(int a_frame) {
  FullModel::Options options;
  options.steps_per_frame = a_frame;
  options.tolerance = 1e-8;
  return options;
}

// All steps are implicit, and the damping leaves only what they resolve.
TEST(ExtrapolatedModel, IsMoreAccurateThanItsShorterSteps) {
  const Model model(box_settings(swinging()), bar_mesh(6, 2, 2));
  const Eigen::MatrixXd truth = motion(ExtrapolatedModel(model, steps(32)), model);
  const auto error = [&](const ForwardModel& forward) { return (motion(forward, model) - truth).norm() / truth.norm(); };
  const double coarse = error(FullModel(model, steps(8))), fine = error(FullModel(model, steps(16)));
  const double extrapolated = error(ExtrapolatedModel(model, steps(8)));
  EXPECT_NEAR(coarse / fine, 4.0, 1.0) << "the steps are not of second order";
  EXPECT_LT(extrapolated, fine / 8.0) << coarse << " " << fine;
}

// Contact is not smooth, and steps that the model file states stay as they are.
TEST(ExtrapolatedModel, IsMadeOfSmoothModelsOnly) {
  BasisOptions options;
  options.extrapolated = true;
  const auto kind = [&](const ModelSettings& settings) {
    const Model model(settings, bar_mesh());
    return make_forward_model(model, options)->description().substr(0, 12);
  };
  EXPECT_EQ(kind(box_settings(swinging())), "extrapolated");
  ModelSettings stepped = box_settings(swinging());
  stepped.time.step = 0.01;
  EXPECT_EQ(kind(stepped).substr(0, 4), "full");
  const std::string floor = "contact_plane: {point: [0, 0, -0.05], normal: [0, 0, 1], stiffness: 1e6}";
  EXPECT_EQ(kind(box_settings(swinging({floor}))).substr(0, 4), "full");
}

}  // namespace
}  // namespace tissue_stiffness
