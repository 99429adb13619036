// Runs that share a factor against runs whose every balance is solved by Newton's method.
#include <gtest/gtest.h>

#include "../box_model.hpp"
#include "forward/full_model.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kStep = 0.008, kRadius = 0.9;

std::vector<std::string> swinging(const std::string& law, const std::string& poisson_ratio = "0.45",
                                  const std::string& gravity = "[0.5, 1, -3]") {
  return {"inertia: {density: 1000}",
          "elasticity: {law: " + law + ", poisson_ratio: " + poisson_ratio + ", young_modulus: {prior: 40e3, factor: 2}}",
          "fixed: {region: clamp}", "gravity: {acceleration: " + gravity + "}", "mass_damping: {alpha: 0.5}"};
}

Eigen::VectorXd at_modulus(const Model& model, double value) {
  return model.parameters().theta(Eigen::VectorXd::Constant(1, model.parameters().free().front().to_coordinate(value)));
}

// Generalised-alpha (Chung & Hulbert 1993) with a fresh factor for every correction, until nothing is left to correct.
class NewtonRun {
 public:
  NewtonRun(const Model& model, const Eigen::VectorXd& theta) : system_(model, theta) {
    u_ = v_ = Eigen::VectorXd::Zero(model.fem().dof_count());
    SparseSolver mass;
    SparseMatrix m = system_.mass();
    fix_dofs(m, system_.fixed(), m.diagonal().mean());
    mass.factorize(m);
    a_ = mass.solve(held(system_.force(0.0, u_, v_) - system_.damping() * v_));
  }

  void step(double h) {
    const double am = (2.0 * kRadius - 1.0) / (kRadius + 1.0), af = kRadius / (kRadius + 1.0), gamma = 0.5 - am + af,
                 beta = 0.25 * (1.0 - am + af) * (1.0 - am + af);
    Eigen::VectorXd a = (1.0 - 0.5 / beta) * a_;  // of a velocity that stays
    for (int k = 0; k < 30; ++k) {
      const Eigen::VectorXd u = u_ + h * v_ + h * h * ((0.5 - beta) * a_ + beta * a),
                            v = v_ + h * ((1.0 - gamma) * a_ + gamma * a), um = (1.0 - af) * u + af * u_,
                            vm = (1.0 - af) * v + af * v_, acm = (1.0 - am) * a + am * a_;
      const double time = time_ + (1.0 - af) * h;
      const Eigen::VectorXd r = held(system_.force(time, um, vm) - system_.mass() * acm - system_.damping() * vm);
      SparseMatrix j = (1.0 - af) * beta * h * h * system_.stiffness(time, um, vm);
      add_scaled(j, 1.0 - am, system_.mass());
      add_scaled(j, (1.0 - af) * gamma * h, system_.damping());
      fix_dofs(j, system_.fixed(), j.diagonal().mean());
      SparseSolver solver;
      solver.factorize(j);
      const Eigen::VectorXd d = solver.solve(r);
      a += d;
      if (beta * h * h * d.cwiseAbs().maxCoeff() < 1e-14) break;
    }
    u_ += h * v_ + h * h * ((0.5 - beta) * a_ + beta * a);
    v_ += h * ((1.0 - gamma) * a_ + gamma * a);
    a_ = a;
    time_ += h;
  }
  const Eigen::VectorXd& displacement() const { return u_; }

 private:
  Eigen::VectorXd held(Eigen::VectorXd x) const {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (system_.fixed()[static_cast<std::size_t>(i)] != 0) x[i] = 0.0;
    }
    return x;
  }

  ModelSystem system_;
  double time_ = 0.0;
  Eigen::VectorXd u_, v_, a_;
};

class SideBySide : public testing::TestWithParam<const char*> {};

TEST_P(SideBySide, AgreesWithNewtonsMethod) {
  const Model model(box_settings(swinging(GetParam())), bar_mesh(6, 2, 2));
  const std::vector<Eigen::VectorXd> thetas{at_modulus(model, 90e3), at_modulus(model, 92e3), at_modulus(model, 180e3)};
  FullModel::Options options;
  options.step = kStep;
  options.tolerance = 1e-9;
  const auto together = FullModel(model, options).start_all(thetas, 0.0);
  std::vector<NewtonRun> exact;
  for (const Eigen::VectorXd& theta : thetas) exact.emplace_back(model, theta);
  double largest = 0.0;
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(model.fem().dof_count(), 3);
  for (int k = 1; k <= 40; ++k) {
    together->advance(std::vector<double>(3, kStep * k));
    together->outputs(u);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      exact[i].step(kStep);
      largest = std::max(largest, exact[i].displacement().cwiseAbs().maxCoeff());
      const double off = (u.col(static_cast<Eigen::Index>(i)) - exact[i].displacement()).cwiseAbs().maxCoeff();
      EXPECT_LT(off, 1e-6) << off << "m, run " << i << ", step " << k;
    }
  }
  EXPECT_GT(largest, 0.01) << "the bar hardly moved";
}

INSTANTIATE_TEST_SUITE_P(Laws, SideBySide, testing::Values("linear", "neo_hookean"),
                         [](const auto& info) { return std::string(info.param); });

// Its pressure is so stiff that the default tolerance would leave it ringing, and an old factor would not serve a body that
// has been deformed since.
TEST(SideBySide, StepsNearlyIncompressibleTissueWithFewFactors) {
  const Model model(box_settings(swinging("neo_hookean", "0.4999", "[0.1, 0.2, -0.6]")), bar_mesh(6, 2, 2));
  const std::vector<Eigen::VectorXd> thetas{at_modulus(model, 50e3), at_modulus(model, 60e3), at_modulus(model, 90e3)};
  std::vector<std::unique_ptr<ModelSystem>> systems;
  std::vector<const DynamicSystem*> views;
  for (const Eigen::VectorXd& theta : thetas) {
    systems.push_back(std::make_unique<ModelSystem>(model, theta));
    views.push_back(systems.back().get());
  }
  GeneralizedAlpha stepper(views, kRadius, 1e-9);
  DynamicState rest;
  rest.displacement = rest.velocity = Eigen::VectorXd::Zero(model.fem().dof_count());
  std::vector<DynamicState> states(thetas.size(), rest);
  stepper.initialise(states);
  constexpr int kSteps = 60;
  double largest = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    stepper.step(states, std::vector<double>(thetas.size(), kStep));
    largest = std::max(largest, states.front().displacement.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(largest, 0.005) << "the bar hardly moved";
  EXPECT_LT(stepper.factorisations(), kSteps / 4);
  EXPECT_LT(stepper.iterations(), 10 * kSteps);
}

TEST(SideBySide, NeglectsLessOfNearlyIncompressibleTissue) {
  const Model model(box_settings(swinging("neo_hookean", "0.4999", "[0.1, 0.2, -0.6]")), bar_mesh(4, 1, 1));
  const Eigen::VectorXd theta = at_modulus(model, 60e3);
  FullModel::Options options;
  options.step = kStep;
  const auto run = FullModel(model, options).start(theta, 0.0);
  NewtonRun exact(model, theta);
  for (int k = 1; k <= 30; ++k) {
    run->advance(kStep * k);
    exact.step(kStep);
    EXPECT_LT((run->displacement() - exact.displacement()).cwiseAbs().maxCoeff(), 4e-8) << "m, step " << k;
  }
}

// Each run alone takes the same way as in company.
TEST(SideBySide, LeavesRunsAsTheyAreAlone) {
  const Model model(box_settings(swinging("neo_hookean")), bar_mesh(4, 1, 1));
  const std::vector<Eigen::VectorXd> thetas{at_modulus(model, 40e3), at_modulus(model, 30e3), at_modulus(model, 20e3)};
  FullModel::Options options;
  options.tolerance = 1e-9;
  const FullModel full(model, options);
  const auto together = full.start_all(thetas, 0.0);
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(model.fem().dof_count(), 3);
  for (int k = 1; k <= 10; ++k) together->advance(std::vector<double>(3, 0.03 * k));
  together->outputs(u);
  for (std::size_t i = 0; i < thetas.size(); ++i) {
    const auto alone = full.start(thetas[i], 0.0);
    for (int k = 1; k <= 10; ++k) alone->advance(0.03 * k);
    EXPECT_LT((alone->displacement() - u.col(static_cast<Eigen::Index>(i))).cwiseAbs().maxCoeff(), 1e-6) << "m";
  }
}

// One whose mass no diagonal can stand for keeps all from explicit steps.
TEST(SideBySide, StepsAsTheMassOfEachAllows) {
  std::vector<std::string> effects = swinging("neo_hookean");
  effects[1] = "elasticity: {law: neo_hookean, poisson_ratio: 0.45, young_modulus: 40e3}";
  effects.push_back("period_elongation: {step_squared: {mean: 0, std: 1.0e-4}}");
  const Model model(box_settings(effects), bar_mesh(4, 1, 1));
  const std::vector<Eigen::VectorXd> thetas{model.parameters().theta(Eigen::VectorXd::Zero(1)),
                                            model.parameters().theta(Eigen::VectorXd::Constant(1, 1e-4))};
  FullModel::Options options;
  options.tolerance = 1e-9;
  const FullModel full(model, options);
  const auto together = full.start_all(thetas, 0.0);
  const auto alone = full.start(thetas[1], 0.0);
  for (int k = 1; k <= 40; ++k) {
    together->advance(std::vector<double>(2, 0.001 * k));
    alone->advance(0.001 * k);
  }
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(model.fem().dof_count(), 2);
  together->outputs(u);
  EXPECT_LT((alone->displacement() - u.col(1)).cwiseAbs().maxCoeff(), 1e-6) << "m";
}

}  // namespace
}  // namespace tissue_stiffness
