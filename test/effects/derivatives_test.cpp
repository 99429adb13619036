// The force of every effect agrees with its tangents, its energy and its linear terms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "every_effect.hpp"

namespace tissue_stiffness {
namespace {

// Strains of some tens of per cent, nothing symmetric about them.
Eigen::VectorXd large_displacement(const TetMesh& mesh) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> value(-3e-4, 3e-4);
  Eigen::VectorXd u(3 * mesh.node_count());
  for (int i = 0; i < mesh.node_count(); ++i) {
    const Eigen::Vector3d x = mesh.nodes.col(i);
    u.segment<3>(3 * i) = Eigen::Vector3d(0.2 * x.x(), 0.01 * std::sin(20.0 * x.x()), 2.0 * x.x() * x.x());
    for (int k = 0; k < 3; ++k) u[3 * i + k] += value(engine);
  }
  return u;
}

// Under finite strain, 0.1 s after the first stamp.
Motion motion(const Eigen::VectorXd& u, const Eigen::VectorXd& v) {
  return {0.1, u, v, 1.0, 1.0, 0.1};
}

// A bar under finite strain whose last part is the effect, on its whole skin if it has a region.
Model neo_hookean_bar(const EffectSpec& spec, const TetMesh& mesh) {
  return Model(box_settings(bar_with(spec.name, example_arguments(spec, "neo_hookean", "skin"), "neo_hookean")), mesh);
}

// Everything in a part's force that is not linear, under finite strain.
Eigen::VectorXd nonlinear_force(const Model& model, const Eigen::VectorXd& u) {
  const Model::Part& part = model.parts().back();
  const Eigen::VectorXd p = part.parameters(model.parameters().theta(model.parameters().prior_mean())),
                        v = Eigen::VectorXd::Zero(u.size());
  Eigen::VectorXd f = Eigen::VectorXd::Zero(u.size());
  if (const NonlinearForce* force = part.effect->nonlinear_force()) force->add_force(motion(u, v), p, f);
  if (const FiniteStrainForm* form = part.effect->finite_strain()) form->add_finite_force(motion(u, v), p, f);
  return f;
}

SparseMatrix nonlinear_tangent(const Model& model, const Eigen::VectorXd& u) {
  const Model::Part& part = model.parts().back();
  const Eigen::VectorXd p = part.parameters(model.parameters().theta(model.parameters().prior_mean())),
                        v = Eigen::VectorXd::Zero(u.size());
  SparseMatrix k = model.fem().pattern();
  if (const NonlinearForce* force = part.effect->nonlinear_force()) force->add_stiffness(motion(u, v), p, k);
  if (const FiniteStrainForm* form = part.effect->finite_strain()) form->add_finite_stiffness(motion(u, v), p, k);
  return k;
}

// The surface is closed, so that a follower pressure's tangent is symmetric and must match to the last entry.
TEST(EveryEffect, TangentEqualsFiniteDifferencesOfTheForce) {
  const TetMesh mesh = bar_mesh(2);
  const Eigen::VectorXd u = large_displacement(mesh);
  int nonlinear = 0;
  for (const EffectSpec& spec : effect_specs()) {
    if (!fits(spec, "neo_hookean")) continue;
    Model model = neo_hookean_bar(spec, mesh);
    feed(model);
    const Model::Part& part = model.parts().back();
    if (part.effect->nonlinear_force() == nullptr && part.effect->finite_strain() == nullptr) continue;
    const SparseMatrix tangent = nonlinear_tangent(model, u);
    ++nonlinear;
    EXPECT_GT(nonlinear_force(model, u).norm(), 0.0) << spec.name << ": the example does nothing";
    const double h = 1e-8;
    Eigen::MatrixXd differences(u.size(), u.size());
    for (Eigen::Index j = 0; j < u.size(); ++j) {
      const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(u.size(), j);
      differences.col(j) = -(nonlinear_force(model, u + step) - nonlinear_force(model, u - step)) / (2.0 * h);
    }
    const double error = (Eigen::MatrixXd(tangent) - differences).cwiseAbs().maxCoeff() / differences.cwiseAbs().maxCoeff();
    std::printf("%s: tangent against differences %.1e\n", spec.name.c_str(), error);
    EXPECT_LT(error, 1e-6) << spec.name;
  }
  EXPECT_GE(nonlinear, 3);
}

// At a velocity of its own for each node; effects whose force depends on it say so.
TEST(EveryEffect, FrictionEqualsFiniteDifferencesByTheVelocity) {
  const TetMesh mesh = bar_mesh(2);
  const Eigen::VectorXd u = large_displacement(mesh), v = 0.1 * large_displacement(mesh).reverse();
  int rubbing = 0;
  for (const EffectSpec& spec : effect_specs()) {
    if (!fits(spec, "linear")) continue;
    Arguments arguments = example_arguments(spec, "linear", "skin");
    for (const ParameterSpec& p : spec.parameters) {
      if (p.name == "friction") arguments[p.name] = "0.4";
    }
    Model model(box_settings(bar_with(spec.name, arguments)), mesh);
    feed(model);
    const Model::Part& part = model.parts().back();
    const Eigen::VectorXd p = part.parameters(model.parameters().theta(model.parameters().prior_mean()));
    const NonlinearForce* rubs = part.effect->nonlinear_force();
    if (rubs == nullptr) continue;
    const auto force = [&](const Eigen::VectorXd& velocity) {
      Eigen::VectorXd f = Eigen::VectorXd::Zero(u.size());
      rubs->add_force(motion(u, velocity), p, f);
      return f;
    };
    if (!rubs->has_velocity_tangent(p)) {
      EXPECT_EQ(force(v), force(-v)) << spec.name << " depends on the velocity but does not say so";
      continue;
    }
    ++rubbing;
    SparseMatrix tangent = model.fem().pattern();
    rubs->add_velocity_tangent(motion(u, v), p, tangent);
    Eigen::MatrixXd differences(u.size(), u.size());
    const double h = 1e-7;
    for (Eigen::Index j = 0; j < u.size(); ++j) {
      const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(u.size(), j);
      differences.col(j) = -(force(v + step) - force(v - step)) / (2.0 * h);
    }
    EXPECT_GT(differences.norm(), 0.0) << spec.name << ": the example does nothing";
    EXPECT_LT((Eigen::MatrixXd(tangent) - differences).cwiseAbs().maxCoeff(), 1e-6 * differences.cwiseAbs().maxCoeff())
        << spec.name;
  }
  EXPECT_EQ(rubbing, 2);
}

// What is left of the linear terms' force when the body hardly moves.
TEST(EveryEffect, FiniteStrainTendsToTheLinearTerms) {
  const TetMesh mesh = bar_mesh(2);
  const Eigen::VectorXd u = 1e-6 * large_displacement(mesh);
  for (const EffectSpec& spec : effect_specs()) {
    if (!fits(spec, "neo_hookean")) continue;
    Model model = neo_hookean_bar(spec, mesh);
    feed(model);
    const Model::Part& part = model.parts().back();
    if (part.effect->finite_strain() == nullptr) continue;
    const Eigen::VectorXd p = part.parameters(model.parameters().theta(model.parameters().prior_mean()));
    SparseMatrix k = model.fem().pattern();
    for (const MatrixTerm& term : part.terms.stiffness) add_scaled(k, term.coefficient(p), *term.matrix);
    for (const StrainTerm& term : part.terms.strain_stiffness) {
      add_strain_stiffness(model.fem(), term.at(p), term.coefficient(p), k);
    }
    Eigen::VectorXd linear = -(k * u);
    for (const LoadTerm& term : part.terms.loads) {
      linear += term.coefficient(p) * model.loads().value(term, p, 1.0, 0.1) * term.pattern;
    }
    if (spec.of_finite_strain) {  // it may hold fibres that are slack on one side, which no linear term tells
      EXPECT_EQ(linear.norm(), 0.0) << spec.name;
      linear = model.reference_stiffness(model.parameters().theta(model.parameters().prior_mean())) * u;
      EXPECT_LT(nonlinear_force(model, u).norm(), 0.5 * linear.norm()) << spec.name;
      EXPECT_LT(nonlinear_force(model, 0.0 * u).norm(), 1e-12 * linear.norm()) << spec.name;
      continue;
    }
    if (part.effect->nonlinear_force() != nullptr) {  // nothing of it is linear
      EXPECT_EQ(linear.norm(), 0.0) << spec.name;
      linear = model.reference_stiffness(model.parameters().theta(model.parameters().prior_mean())) * u;
      EXPECT_LT(nonlinear_force(model, u).norm(), 1e-5 * linear.norm()) << spec.name;
      continue;
    }
    EXPECT_GT(linear.norm(), 0.0) << spec.name;
    EXPECT_LT((nonlinear_force(model, u) - linear).norm(), 1e-5 * linear.norm()) << spec.name;
  }
}

// The force is what the stored energy loses along a displacement.
TEST(EveryEffect, WithAnEnergyHasItsDerivativeForItsForce) {
  const TetMesh mesh = bar_mesh(2);
  const Eigen::VectorXd u = large_displacement(mesh), along = large_displacement(mesh).reverse(),
                        v = Eigen::VectorXd::Zero(u.size());
  int compared = 0;
  for (const EffectSpec& spec : effect_specs()) {
    if (!fits(spec, "neo_hookean")) continue;
    Model model = neo_hookean_bar(spec, mesh);
    feed(model);
    const Model::Part& part = model.parts().back();
    const Eigen::VectorXd p = part.parameters(model.parameters().theta(model.parameters().prior_mean()));
    const auto energy = [&](double step) {
      const Eigen::VectorXd moved = u + step * along;
      return part.effect->energy(motion(moved, v), p);
    };
    if (part.effect->finite_strain() == nullptr || energy(0.0) == 0.0) continue;
    const double h = 1e-5, slope = (energy(h) - energy(-h)) / (2.0 * h);
    EXPECT_NEAR(-nonlinear_force(model, u).dot(along), slope, 1e-6 * std::abs(slope)) << spec.name;
    ++compared;
  }
  EXPECT_EQ(compared, 8);
}

}  // namespace
}  // namespace tissue_stiffness
