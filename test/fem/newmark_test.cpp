// Time stepping: energy, order, and what happens when a step fails.
#include "tissue_stiffness/fem/newmark.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "elastic_body.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Law = ElasticBody::Law;

constexpr double kDensity = 1000.0;
const Lame kLame = lame(30e3, 0.4);

TetMesh bar() {
  return make_box_mesh({0.10, 0.02, 0.02}, 5, 1, 1, 2);
}

ElasticBody clamped_bar(const TetMesh& mesh, Law law) {
  return {mesh, law, kLame, kDensity, clamped_dofs(mesh)};
}

Eigen::VectorXd weight(const ElasticBody& body, double acceleration) {
  Eigen::VectorXd g = Eigen::VectorXd::Zero(body.fem().dof_count());
  for (Eigen::Index i = 2; i < g.size(); i += 3) g[i] = -acceleration;
  return body.mass() * g;
}

// Bent by its own weight, then let go without it.
DynamicState released(ElasticBody& body, double acceleration) {
  const Eigen::VectorXd load = weight(body, acceleration), zero = Eigen::VectorXd::Zero(load.size());
  DynamicState state;
  state.displacement = zero;
  for (const double part : {0.25, 0.5, 0.75, 1.0}) {
    body.set_load(part * load);
    state.displacement = equilibrium(body, zero, state.displacement);
  }
  state.velocity = zero;
  body.set_load(zero);
  return state;
}

// Largest change of the energy over a second, relative to the energy at the start.
double drift(ElasticBody& body, double acceleration, double step) {
  DynamicState state = released(body, acceleration);
  Newmark newmark(body, 1.0, 1e-12);
  newmark.initialise(state);
  const double start = body.energy(state.displacement, state.velocity);
  double worst = 0.0, fastest = 0.0;
  while (state.time < 1.0 - 0.5 * step) {
    newmark.step(state, step);
    worst = std::max(worst, std::abs(body.energy(state.displacement, state.velocity) / start - 1.0));
    fastest = std::max(fastest, body.kinetic_energy(state.velocity) / start);
  }
  EXPECT_GT(fastest, 0.5);  // it did swing
  return worst;
}

TEST(Newmark, KeepsTheEnergyOfALinearBar) {
  const TetMesh mesh = bar();
  ElasticBody body = clamped_bar(mesh, Law::linear);
  const double worst = drift(body, 2.0, 2e-3);
  std::printf("energy drift over 1 s, linear bar: %.1e\n", worst);
  EXPECT_LT(worst, 1e-8);
}

TEST(Newmark, KeepsTheEnergyOfANeoHookeanBar) {
  const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, 2);
  ElasticBody body = clamped_bar(mesh, Law::neo_hookean);
  const double worst = drift(body, 3.0, 1e-3);
  std::printf("energy drift over 1 s, neo-Hookean bar: %.1e\n", worst);
  EXPECT_LT(worst, 1e-4);
}

Eigen::VectorXd run(ElasticBody& body, double radius, double duration, int steps) {
  DynamicState state = released(body, 3.0);
  Newmark newmark(body, radius, 1e-13);
  newmark.initialise(state);
  for (int k = 0; k < steps; ++k) newmark.step(state, duration / steps);
  return state.displacement;
}

// log2 of the ratio of successive differences when the step is halved.
double order_in_time(ElasticBody& body, double radius) {
  const double duration = 0.12;
  const Eigen::VectorXd coarse = run(body, radius, duration, 60), middle = run(body, radius, duration, 120),
                        fine = run(body, radius, duration, 240);
  return std::log2((coarse - middle).norm() / (middle - fine).norm());
}

TEST(Newmark, ConvergesWithSecondOrder) {
  const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, 2);
  for (const Law law : {Law::linear, Law::neo_hookean}) {
    for (const double radius : {1.0, 0.7}) {
      ElasticBody body = clamped_bar(mesh, law);
      body.set_damping(2.0 * body.mass() + 1e-3 * linear_stiffness(body.fem(), kLame));
      const double order = order_in_time(body, radius);
      std::printf("order in time, %s, spectral radius %.1f: %.2f\n", law == Law::linear ? "linear" : "neo-Hookean", radius,
                  order);
      EXPECT_NEAR(order, 2.0, 0.1);
    }
  }
}

TEST(Newmark, FallsFreelyExactly) {
  const TetMesh mesh = make_box_mesh({0.02, 0.02, 0.02}, 1, 1, 1, 2);
  ElasticBody body(mesh, Law::neo_hookean, kLame, kDensity,
                   std::vector<char>(static_cast<std::size_t>(3 * mesh.node_count()), 0));
  body.set_load(weight(body, 9.81));
  DynamicState state;
  state.displacement = state.velocity = Eigen::VectorXd::Zero(body.fem().dof_count());
  Newmark newmark(body, 1.0, 1e-12);
  newmark.initialise(state);
  for (int k = 0; k < 20; ++k) newmark.step(state, 0.005);
  const Eigen::VectorXd exact = nodal(mesh, [](const Eigen::Vector3d&) -> Eigen::Vector3d {
    return {0.0, 0.0, -0.5 * 9.81 * 0.1 * 0.1};
  });
  EXPECT_LT((state.displacement - exact).cwiseAbs().maxCoeff(), 1e-12);
}

// Remembers the instants at which it was asked.
class Watched : public ElasticBody {
 public:
  using ElasticBody::ElasticBody;
  Eigen::VectorXd force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const override {
    times.insert(time);
    return ElasticBody::force(time, u, v);
  }
  mutable std::set<double> times;
};

TEST(Newmark, CutsAStepThatIsTooLong) {
  const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, 2);
  const Watched body(mesh, Law::neo_hookean, kLame, kDensity, clamped_dofs(mesh));
  DynamicState state;
  state.displacement = state.velocity = Eigen::VectorXd::Zero(body.fem().dof_count());
  // Thrown against its clamp so fast that one step would push it through.
  for (Eigen::Index i = 0; i < state.velocity.size(); i += 3) {
    if (body.fixed()[static_cast<std::size_t>(i)] == 0) state.velocity[i] = -4.0;
  }
  Newmark newmark(body, 1.0, 1e-10);
  newmark.initialise(state);
  const double energy = body.energy(state.displacement, state.velocity);
  newmark.step(state, 0.04);
  EXPECT_NEAR(state.time, 0.04, 1e-12);
  EXPECT_GT(body.times.size(), 2U) << "the whole step was possible at once";
  EXPECT_TRUE(state.displacement.allFinite());
  EXPECT_LT(body.energy(state.displacement, state.velocity), 1.5 * energy);
}

// A load that no step can follow.
class Impossible : public ElasticBody {
 public:
  using ElasticBody::ElasticBody;
  Eigen::VectorXd force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const override {
    if (time > 0.0) throw NumericalError("nothing works");
    return ElasticBody::force(time, u, v);
  }
};

TEST(Newmark, ReportsADivergingStepAndLeavesTheState) {
  const TetMesh mesh = make_box_mesh({0.02, 0.02, 0.02}, 1, 1, 1, 1);
  const Impossible body(mesh, Law::linear, kLame, kDensity, clamped_dofs(mesh));
  DynamicState state;
  state.displacement = state.velocity = random_vector(body.fem().dof_count(), 1e-4, 1);
  for (Eigen::Index i = 0; i < state.displacement.size(); ++i) {
    if (body.fixed()[static_cast<std::size_t>(i)] != 0) state.displacement[i] = state.velocity[i] = 0.0;
  }
  Newmark newmark(body, 1.0, 1e-10);
  newmark.initialise(state);
  const DynamicState before = state;
  EXPECT_THROW(newmark.step(state, 0.01), NumericalError);
  EXPECT_EQ(state.time, before.time);
  EXPECT_EQ(state.displacement, before.displacement);
  EXPECT_EQ(state.velocity, before.velocity);
}

}  // namespace
}  // namespace tissue_stiffness
