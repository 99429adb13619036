// How a run starts that does not start from rest.
#include <gtest/gtest.h>

#include <cmath>

#include "../box_model.hpp"
#include "forward/full_model.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {
namespace {

std::vector<std::string> bar(const std::string& initial_motion, const std::string& modulus = "3.0e4") {
  return {
      "inertia: {density: 1000}",        "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: " + modulus + "}",
      "fixed: {region: clamp}",          "gravity: {acceleration: [0.5, 1, -2]}",
      "viscous_damping: {beta: 2.0e-3}", "initial_motion: {" + initial_motion + "}"};
}

double largest(const Eigen::VectorXd& u) {
  return std::sqrt(Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, u.size() / 3).colwise().squaredNorm().maxCoeff());
}

TEST(InitialMotion, ABodyInEquilibriumStaysThere) {
  const Model model(box_settings(bar("")), bar_mesh());
  const Eigen::VectorXd theta = model.parameters().known();
  const ReducedModel reduced(model);
  const auto run = reduced.start(theta, 0.0);
  const Eigen::VectorXd begin = run->displacement();
  EXPECT_GT(largest(begin), 1e-3);
  run->advance(0.37);
  EXPECT_LT(largest(run->displacement() - begin), 1e-9 * largest(begin));
}

TEST(InitialMotion, WithoutEquilibriumTheBodyStartsUndeformed) {
  const Model model(box_settings(bar("equilibrium: 0")), bar_mesh());
  const ReducedModel reduced(model);
  EXPECT_EQ(largest(reduced.start(model.parameters().known(), 0.0)->displacement()), 0.0);
}

// Amplitudes are displacements and velocities of the point that moves most.
TEST(InitialMotion, AmplitudesHaveTheirUnits) {
  const std::string none = "equilibrium: 0, ";
  const Model bent(box_settings(bar(none + "displacement: [0, 0.002, 0]")), bar_mesh());
  const ReducedModel bending(bent);
  const auto run = bending.start(bent.parameters().known(), 0.0);
  EXPECT_NEAR(largest(run->displacement()), 0.002, 1e-12);
  EXPECT_EQ(largest(run->velocity()), 0.0);
  const Model thrown(box_settings(bar(none + "second_velocity: [0, 0, 0.03]")), bar_mesh());
  const ReducedModel throwing(thrown);
  const auto moving = throwing.start(thrown.parameters().known(), 0.0);
  EXPECT_NEAR(largest(moving->velocity()), 0.03, 1e-12);
  EXPECT_EQ(largest(moving->displacement()), 0.0);
}

// The first three bend the body along their axis, and the others hold nothing of them.
TEST(InitialMotion, TheSecondShapesAreOrthogonalToTheFirst) {
  const Model model(box_settings(bar("")), bar_mesh());
  const ReducedModel reduced(model);
  const Eigen::MatrixXd& shapes = reduced.start_shapes();
  const Eigen::MatrixXd u = reduced.basis() * shapes;
  const SparseMatrix mass = model.mass(model.parameters().known());
  for (int axis = 0; axis < 3; ++axis) {
    const double across = u.col(axis).dot(mass * u.col(3 + axis));
    EXPECT_LT(std::abs(across), 1e-9 * u.col(axis).dot(mass * u.col(axis)));
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < u.rows(); ++i) along[i % 3] += std::abs(u(i, axis));
    Eigen::Index most = 0;
    along.maxCoeff(&most);
    EXPECT_EQ(most, axis);
    EXPECT_GT(along[axis], 0.0);
  }
}

// The shapes are those of the prior: a modulus that is estimated must not change what its amplitudes mean.
TEST(InitialMotion, TheShapesDoNotChangeWithTheModulus) {
  const Model model(box_settings(bar("equilibrium: 0, displacement: [0.001, 0.002, 0]", "{prior: 3.0e4, factor: 3}")),
                    bar_mesh());
  const ReducedModel reduced(model);
  const Eigen::VectorXd w = model.parameters().prior_mean();
  const Eigen::VectorXd there = reduced.start(model.parameters().theta(w), 0.0)->displacement();
  const Eigen::VectorXd away = reduced.start(model.parameters().theta(w.array() + 0.7), 0.0)->displacement();
  EXPECT_LT(largest(there - away), 1e-9 * largest(there));
}

TEST(InitialMotion, AFullRunStartsAsTheReducedOne) {
  const Model model(box_settings(bar("displacement: [0.001, 0.002, 0], velocity: [0, 0, 0.05]")), bar_mesh());
  const Eigen::VectorXd theta = model.parameters().known();
  const ReducedModel in_modes(model);
  const FullModel in_full(model, {});
  const auto reduced = in_modes.start(theta, 0.0), full = in_full.start(theta, 0.0);
  EXPECT_LT(largest(full->displacement() - reduced->displacement()), 1e-6 * largest(reduced->displacement()));
  for (int k = 1; k <= 20; ++k) {
    reduced->advance(0.005 * k);
    full->advance(0.005 * k);
  }
  EXPECT_LT(largest(full->displacement() - reduced->displacement()), 0.02 * largest(reduced->displacement()));
}

}  // namespace
}  // namespace tissue_stiffness
