// Effects seen in motion: decay of a mode, a fall on a plane.
#include <gtest/gtest.h>

#include <cmath>

#include "../box_model.hpp"
#include "fem/sparse_solver.hpp"
#include "forward/full_model.hpp"

namespace tissue_stiffness {
namespace {

const std::string kInertia = "inertia: {density: 1000}";
const std::string kLinear = "elasticity: {law: linear, young_modulus: 3.0e4, poisson_ratio: 0.4}";
const std::string kFinite = "elasticity: {law: neo_hookean, young_modulus: 3.0e4, poisson_ratio: 0.4}";

Eigen::VectorXd prior(const Model& model) {
  return model.parameters().theta(model.parameters().prior_mean());
}

struct Mode {
  Eigen::VectorXd shape;  ///< times the mass matrix: gives the modal coordinate of a displacement
  double omega;           ///< [rad/s]
};

Mode first_mode(const Model& model) {
  const SparseMatrix mass = model.mass(prior(model));
  SparseMatrix k = model.reference_stiffness(prior(model));
  fix_dofs(k, model.fixed(), k.diagonal().mean());
  SparseSolver solver;
  solver.factorize(k);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(k.rows());
  // Along y + z the mesh is symmetric: of the two modes that bend the square bar this finds one and not a mixture.
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = i % 3 == 0 ? 0.0 : 1.0;
  for (int pass = 0; pass < 40; ++pass) {
    Eigen::VectorXd load = mass * x;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (model.fixed()[static_cast<std::size_t>(i)] != 0) load[i] = 0.0;
    }
    x = solver.solve(load);
    x /= std::sqrt(x.dot(mass * x));
  }
  return {mass * x, std::sqrt(x.dot(k * x))};
}

double damping_rate_of_first_mode(const std::string& law, const std::string& damping, double expected) {
  const TetMesh mesh = bar_mesh(3);
  // Slow enough for small strain whatever the law.
  const Model model(box_settings({kInertia, law, "fixed: {region: clamp}", damping},
                                 "[{vertices: {topic: /v, noise: 1.0e-4}}]", "initial: {velocity: [0, 0, -0.001]}"),
                    mesh);
  const Mode mode = first_mode(model);
  const double period = 2.0 * M_PI / std::sqrt(mode.omega * mode.omega - expected * expected);
  FullModel::Options options;
  options.step = period / 400.0;
  const auto run = FullModel(model, options).start(prior(model), 0.0);
  const double start = mode.shape.dot(run->velocity());
  run->advance(period);  // the mode passes through rest again; its speed has fallen by exp(-rate period)
  return -std::log(mode.shape.dot(run->velocity()) / start) / period;
}

double first_frequency() {
  return first_mode(Model(box_settings({kInertia, kLinear, "fixed: {region: clamp}"}), bar_mesh(3))).omega;
}

TEST(Damping, MassDampingDecaysAtHalfAlpha) {
  for (const std::string& law : {kLinear, kFinite}) {
    EXPECT_NEAR(damping_rate_of_first_mode(law, "mass_damping: {alpha: 2}", 1.0), 1.0, 0.005);
  }
}

TEST(Damping, ViscousDampingDecaysAtHalfBetaOmegaSquared) {
  const double omega = first_frequency(), rate = 0.5 * 0.01 * omega * omega;
  for (const std::string& law : {kLinear, kFinite}) {
    EXPECT_NEAR(damping_rate_of_first_mode(law, "viscous_damping: {beta: 0.01}", rate), rate, 0.005 * rate);
  }
}

TEST(Damping, BothAddUp) {
  const double omega = first_frequency(), rate = 0.5 * (2.0 + 0.005 * omega * omega);
  const Model model(box_settings({kInertia, kLinear, "mass_damping: {alpha: 1.5}", "mass_damping: {alpha: 0.5}",
                                  "viscous_damping: {beta: 0.005}"}),
                    bar_mesh(1));
  EXPECT_EQ(model.mass_damping(prior(model)), 2.0);
  EXPECT_EQ(model.stiffness_damping(prior(model)), 0.005);
  EXPECT_NEAR(damping_rate_of_first_mode(kLinear, "mass_damping: {alpha: 2}\n- viscous_damping: {beta: 0.005}", rate), rate,
              0.005 * rate);
}

// A block of the bar's cross-section over a plane, falling from 4 mm at 0.4 m/s.
class Fall : public testing::Test {
 protected:
  static constexpr double kHeight = 0.004, kSpeed = 0.4, kMass = 1000.0 * 8e-6;
  void make(const std::string& contact, const std::string& velocity = "[0, 0, -0.4]") {
    ModelSettings settings =
        box_settings({kInertia, "elasticity: {law: neo_hookean, young_modulus: 1.0e5, poisson_ratio: 0.4}",
                      "gravity: {acceleration: [0, 0, -9.81]}", contact},
                     "[{vertices: {topic: /v, noise: 1.0e-4}}]", "initial: {velocity: " + velocity + "}");
    settings.regions.clear();
    mesh_ = make_box_mesh({0.02, 0.02, 0.02}, 2, 2, 2, 2);
    model_ = std::make_unique<Model>(settings, mesh_);
    FullModel::Options options;
    options.step = 1e-4;
    run_ = FullModel(*model_, options).start(prior(*model_), 0.0);
  }
  double lowest() const {
    double z = 1.0;
    for (int i = 0; i < mesh_.node_count(); ++i) z = std::min(z, mesh_.nodes(2, i) + run_->displacement()[3 * i + 2]);
    return z;
  }
  double energy() const {
    return ModelSystem(*model_, prior(*model_)).energy(run_->time(), run_->displacement(), run_->velocity());
  }
  Eigen::Vector3d momentum() const {
    const Eigen::VectorXd p = model_->mass(prior(*model_)) * run_->velocity();
    return Eigen::Map<const Eigen::Matrix3Xd>(p.data(), 3, p.size() / 3).rowwise().sum();
  }
  TetMesh mesh_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<Trajectory> run_;
};

TEST_F(Fall, ThePlaneThrowsTheBlockBackAndKeepsItsEnergy) {
  make("contact_plane: {point: [0, 0, -0.004], normal: [0, 0, 2]}");
  const double start = energy(), before = momentum().z();
  EXPECT_NEAR(before, -kSpeed * kMass, 1e-12);
  const double impact = kMass * std::sqrt(kSpeed * kSpeed + 2.0 * 9.81 * kHeight);
  double deepest = 1.0, worst = 0.0, upwards = 0.0;
  for (int k = 1; k <= 60; ++k) {
    run_->advance(5e-4 * k);
    deepest = std::min(deepest, lowest() + kHeight);
    worst = std::max(worst, std::abs(energy() / start - 1.0));
    upwards = std::max(upwards, momentum().z());
  }
  std::printf("fall: penetration %.2f mm, energy within %.1e, momentum thrown back %.2f\n", -1e3 * deepest, worst,
              upwards / impact);
  EXPECT_LT(deepest, 0.0);        // it was touched
  EXPECT_GT(deepest, -0.001);     // and hardly entered
  EXPECT_GT(lowest(), -kHeight);  // and left again
  EXPECT_LT(worst, 0.02);
  EXPECT_GT(upwards / impact, 0.7);                                 // the rest rings inside the block
  EXPECT_LT(momentum().head<2>().norm(), 0.02 * std::abs(before));  // no friction (and a mesh that is not quite symmetric)
}

// Slides 0.4^2 / (2 mu g) = 16 mm, rocking on its soft underside; then it rests.
TEST_F(Fall, FrictionStopsASlidingBlockWhereCoulombSays) {
  const std::string plane = "contact_plane: {point: [0, 0, 0], normal: [0, 0, 1], friction: 0.5}";
  make(plane, "[0.4, 0, 0]");
  run_->advance(0.16);
  const auto place = [&] {
    const Eigen::VectorXd p = model_->mass(prior(*model_)) * run_->displacement();
    return Eigen::Map<const Eigen::Matrix3Xd>(p.data(), 3, p.size() / 3).rowwise().sum().x() / kMass;
  };
  const double stopped = place();
  run_->advance(0.26);
  const double expected = 0.4 * 0.4 / (2.0 * 0.5 * 9.81);
  std::printf("friction: slid %.2f mm, Coulomb's law %.2f mm; 0.1 s later %.2f mm\n", 1e3 * stopped, 1e3 * expected,
              1e3 * place());
  EXPECT_NEAR(stopped, expected, 0.05 * expected);
  EXPECT_NEAR(place(), stopped, 0.01 * expected);
}

TEST_F(Fall, TheGapMovesThePlaneAlongItsNormal) {
  make("contact_plane: {point: [0, 0, -0.004], normal: [0, 0, 1], gap: 0.003}");
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model_->fem().dof_count());
  Eigen::VectorXd lowered = rest;
  for (Eigen::Index i = 2; i < lowered.size(); i += 3) lowered[i] = -0.0015;
  const auto push = [&](const Eigen::VectorXd& u) {
    Eigen::VectorXd f = rest;
    const Model::Part& part = model_->parts().back();
    part.effect->nonlinear_force()->add_force({0.0, u, rest}, part.parameters(prior(*model_)), f);
    return f.sum();
  };
  EXPECT_EQ(push(rest), 0.0);  // 1 mm above
  EXPECT_GT(push(lowered), 0.0);
}

TEST_F(Fall, TheGivenStiffnessIsForcePerVolumeOfPenetration) {
  make("contact_plane: {point: [0, 0, 0], normal: [0, 0, 1], stiffness: 2.0e6}");
  Eigen::VectorXd u = Eigen::VectorXd::Zero(model_->fem().dof_count()), f = u;
  const Eigen::VectorXd rest = u;
  for (Eigen::Index i = 2; i < u.size(); i += 3) u[i] = -0.0005;
  const Model::Part& part = model_->parts().back();
  part.effect->nonlinear_force()->add_force({0.0, u, rest}, part.parameters(prior(*model_)), f);
  // The underside sinks in by 0.5 mm; the sides' lowest points lean on the plane too, by at most as much again.
  const double underside = 2.0e6 * 0.0005 * 0.02 * 0.02;
  EXPECT_GE(f.sum(), underside * (1.0 - 1e-12));
  EXPECT_LT(f.sum(), 1.2 * underside);
}

}  // namespace
}  // namespace tissue_stiffness
