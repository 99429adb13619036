// Time stepping: free fall, and what happens when a step fails.
#include "fem/generalized_alpha.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tissue_stiffness/types/error.hpp"
#include "verification/elastic_body.hpp"

namespace tissue_stiffness {
namespace {

using Law = ElasticBody::Law;

constexpr double kDensity = 1000.0;
const Lame kLame = lame(30e3, 0.4);

TEST(GeneralizedAlpha, FallsFreelyExactly) {
  const TetMesh mesh = make_box_mesh({0.02, 0.02, 0.02}, 1, 1, 1, 2);
  ElasticBody body(mesh, Law::neo_hookean, kLame, kDensity,
                   std::vector<char>(static_cast<std::size_t>(3 * mesh.node_count()), 0));
  body.set_load(weight(body, 9.81));
  DynamicState state;
  state.displacement = state.velocity = Eigen::VectorXd::Zero(body.fem().dof_count());
  GeneralizedAlpha newmark(body, 1.0, 1e-12);
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
  void add_force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v, Eigen::VectorXd& force) const override {
    times.insert(time);
    ElasticBody::add_force(time, u, v, force);
  }
  mutable std::set<double> times;
};

TEST(GeneralizedAlpha, CutsAStepThatIsTooLong) {
  const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, 2);
  const Watched body(mesh, Law::neo_hookean, kLame, kDensity, clamped_dofs(mesh));
  DynamicState state;
  state.displacement = state.velocity = Eigen::VectorXd::Zero(body.fem().dof_count());
  // Thrown against its clamp so fast that one step would push it through.
  for (Eigen::Index i = 0; i < state.velocity.size(); i += 3) {
    if (body.fixed()[static_cast<std::size_t>(i)] == 0) state.velocity[i] = -4.0;
  }
  GeneralizedAlpha newmark(body, 1.0, 1e-10);
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
  void add_force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v, Eigen::VectorXd& force) const override {
    if (time > 0.0) throw NumericalError("nothing works");
    ElasticBody::add_force(time, u, v, force);
  }
};

TEST(GeneralizedAlpha, ReportsADivergingStepAndLeavesTheState) {
  const TetMesh mesh = make_box_mesh({0.02, 0.02, 0.02}, 1, 1, 1, 1);
  const Impossible body(mesh, Law::linear, kLame, kDensity, clamped_dofs(mesh));
  DynamicState state;
  state.displacement = state.velocity = random_vector(body.fem().dof_count(), 1e-4, 1);
  for (Eigen::Index i = 0; i < state.displacement.size(); ++i) {
    if (body.fixed()[static_cast<std::size_t>(i)] != 0) state.displacement[i] = state.velocity[i] = 0.0;
  }
  GeneralizedAlpha newmark(body, 1.0, 1e-10);
  newmark.initialise(state);
  const DynamicState before = state;
  EXPECT_THROW(newmark.step(state, 0.01), NumericalError);
  EXPECT_EQ(state.time, before.time);
  EXPECT_EQ(state.displacement, before.displacement);
  EXPECT_EQ(state.velocity, before.velocity);
}

}  // namespace
}  // namespace tissue_stiffness
