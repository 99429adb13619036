// What every effect of the library owes: a new effect is tested here without a new test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <set>

#include "../box_model.hpp"
#include "effects/registry.hpp"
#include "forward/full_model.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {
namespace {

using Arguments = std::map<std::string, std::string>;

std::string text(double value) {
  std::ostringstream stream;
  stream.precision(17);
  stream << std::scientific << value;
  return stream.str();
}

// A value of the parameter as YAML, repeated for a vector.
std::string text(const ParameterSpec& parameter, double value) {
  if (parameter.components == 1) return text(value);
  std::string list;
  for (int i = 0; i < parameter.components; ++i) list += (i > 0 ? ", " : "[") + text(value);
  return list + "]";
}

// A value that does something on the bar, or one inside the bounds and away from their ends.
std::string example(const EffectSpec& spec, const ParameterSpec& parameter) {
  static const Arguments typical{
      {"initial_motion.equilibrium", "0.5"},
      {"initial_motion.displacement", "[0.001, -0.002, 0.001]"},
      {"initial_motion.velocity", "[0.02, 0.05, -0.03]"},
      {"initial_motion.second_displacement", "[0.0002, 0.0004, -0.0003]"},
      {"initial_motion.second_velocity", "[0.01, 0.02, -0.01]"},
      {"viscoelasticity.gamma", "0.5"},
      {"viscoelasticity.tau", "0.01"},
      {"elastic_support.compliance", "1.0e-6"},
      {"foundation.stiffness", "1.0e5"},
      {"stiff_inclusion.excess", "2"},
      {"stiff_inclusion.center", "[0.03, 0.01, 0.01]"},
      {"stiff_inclusion.radius", "0.012"},
      {"fibre_reinforcement.modulus", "2.0e4"},
      {"active_contraction.amplitude", "800"},
      {"compressibility.shift", "0.05"},
      {"strain_stiffening.exponent", "5"},
      {"mooney_rivlin.share", "0.4"},
      {"ogden.exponent", "-4.7"},
      {"holzapfel_gasser_ogden.stiffness", "2.0e3"},
      {"holzapfel_gasser_ogden.exponent", "1.5"},
      {"holzapfel_gasser_ogden.dispersion", "0.1"},
      {"density_error.relative", "0.2"},
      {"force_scale.relative", "0.2"},
      {"load_offset.force", "[0.01, 0.02, -0.01]"},
      {"pressure_offset.pressure", "20"},
      {"image_scale.ratio", "1.1"},
      {"time_offset.offset", "0.004"},
      {"contour_bias.bias", "0.001"},
      {"period_elongation.step_squared", "1.0e-5"},
      {"tool_contact.radius", "0.012"},
  };
  const auto known = typical.find(spec.name + "." + parameter.name);
  if (known != typical.end()) return known->second;
  if (parameter.lower > 0.0) return text(parameter, std::sqrt(parameter.lower * parameter.upper));
  return text(parameter, parameter.lower + 0.6 * (parameter.upper - parameter.lower));
}

// Keys that an effect can do without say so.
bool optional(const std::string& meaning) {
  const auto says = [&](const char* words) { return meaning.find(words) != std::string::npos; };
  return says("without it") || says("instead of") || says("when absent");
}

bool optional(const ParameterSpec& parameter) {
  return parameter.presence == ParameterSpec::Default::optional;
}

// Arguments that the spec accepts; keys that are no parameters are filled by what they are called everywhere.
Arguments example_arguments(const EffectSpec& spec, const std::string& law, const std::string& region = "tip") {
  Arguments arguments;
  for (const ParameterSpec& parameter : spec.parameters) {
    const bool idle = parameter.value == parameter.absent;  // what it does without saying so is nothing
    if (!optional(parameter) || idle) arguments[parameter.name] = example(spec, parameter);
  }
  const Arguments known{{"law", law},       {"point", "[0.03, 0, 0]"},      {"normal", "[1, 0.2, 0.1]"},
                        {"topic", "/load"}, {"direction", "[1, 0.5, 0.2]"}, {"center", "[0.001, 0.002, 0.003]"}};
  for (const auto& key : spec.keys) {
    if (optional(key.second)) continue;
    if (key.first == "region") arguments["region"] = spec.name == "elastic_support" ? "clamp" : region;
    if (known.count(key.first) == 1) arguments[key.first] = known.at(key.first);
  }
  return arguments;
}

std::string entry(const std::string& name, const Arguments& arguments) {
  std::string list;
  for (const auto& argument : arguments) list += (list.empty() ? "" : ", ") + argument.first + ": " + argument.second;
  return name + ": {" + list + "}";
}

// A held bar that sags, with the effect in question in place of its namesake or behind the others.
std::vector<std::string> bar_with(const std::string& name, const Arguments& arguments, const std::string& law = "linear") {
  std::vector<std::string> effects;
  if (name != "inertia") effects.push_back("inertia: {density: 1000}");
  if (name != "elasticity") effects.push_back("elasticity: {law: " + law + ", young_modulus: 3.0e4, poisson_ratio: 0.4}");
  effects.push_back("fixed: {region: clamp}");
  effects.push_back("gravity: {acceleration: [0.5, 1, -2]}");
  effects.push_back("traction: {region: tip, topic: /push, scale: 0.005}");
  if (name == "load_rotation" && arguments.count("region") > 0 && arguments.at("region") != "tip")
    effects.push_back("traction: {region: " + arguments.at("region") + ", topic: /push, scale: 0.005}");
  if (!name.empty()) effects.push_back(entry(name, arguments));
  return effects;
}

// Whether an effect goes with a law of the elasticity: finite strain on top of finite strain means nothing.
bool fits(const EffectSpec& spec, const std::string& law) {
  return law == "linear" ? !spec.of_finite_strain : spec.name != "geometric_nonlinearity";
}
std::string fitting_law(const EffectSpec& spec) {
  return fits(spec, "linear") ? "linear" : "neo_hookean";
}
Arguments example_arguments(const EffectSpec& spec) {
  return example_arguments(spec, fitting_law(spec));
}

std::string refused(const std::string& name, const Arguments& arguments, const std::string& law = "linear") {
  static const TetMesh mesh = bar_mesh(2);
  return refusal([&] { const Model model(box_settings(bar_with(name, arguments, law)), mesh); });
}
std::string refused(const EffectSpec& spec, const Arguments& arguments) {
  return refused(spec.name, arguments, fitting_law(spec));
}

TEST(EveryEffect, IsDescribedAndHasAFileOfItsName) {
  std::set<std::string> names;
  for (const EffectSpec& spec : effect_specs()) {
    EXPECT_TRUE(names.insert(spec.name).second) << spec.name << " twice";
    const std::string file = std::string(TISSUE_STIFFNESS_SOURCE_DIR) + "/src/effects/" + spec.name + ".cpp";
    EXPECT_TRUE(std::ifstream(file).good()) << file;
    EXPECT_FALSE(spec.summary.empty()) << spec.name;
    EXPECT_FALSE(spec.formula.empty()) << spec.name;
    EXPECT_FALSE(spec.source.empty()) << spec.name;
    bool topic = false;
    for (const auto& key : spec.keys) {
      EXPECT_FALSE(key.second.empty()) << spec.name << "." << key.first;
      topic = topic || key.first == "topic";
    }
    EXPECT_EQ(topic, spec.load.has_value()) << spec.name << ": nodes and checks ask what its topic carries";
  }
  EXPECT_GE(names.size(), 10U);
}

TEST(EveryEffect, HasUnitsAndBounds) {
  for (const EffectSpec& spec : effect_specs()) {
    for (const ParameterSpec& p : spec.parameters) {
      const std::string name = spec.name + "." + p.name;
      EXPECT_FALSE(p.name.empty() || p.symbol.empty() || p.unit.empty()) << name;
      EXPECT_LT(p.lower, p.upper) << name;
      EXPECT_TRUE(std::isfinite(p.lower) && std::isfinite(p.upper)) << name;
      EXPECT_TRUE(p.components == 1 || p.components == 3) << name;
      if (p.presence == ParameterSpec::Default::optional) {
        EXPECT_TRUE(p.value >= p.lower && p.value <= p.upper) << name;
      }
    }
  }
}

TEST(EveryEffect, IsBuiltFromItsSpec) {
  for (const EffectSpec& spec : effect_specs()) {
    EXPECT_EQ(refused(spec, example_arguments(spec)), "") << spec.name;
  }
}

TEST(EveryEffect, RefusesAnUnknownKey) {
  for (const EffectSpec& spec : effect_specs()) {
    Arguments arguments = example_arguments(spec);
    arguments["colour"] = "1";
    EXPECT_NE(refused(spec, arguments).find(spec.name + ".colour"), std::string::npos) << spec.name;
  }
}

TEST(EveryEffect, RefusesAMissingKey) {
  for (const EffectSpec& spec : effect_specs()) {
    for (const auto& argument : example_arguments(spec)) {
      const auto named = [&](const ParameterSpec& p) { return p.name == argument.first && optional(p); };
      if (std::any_of(spec.parameters.begin(), spec.parameters.end(), named)) continue;
      Arguments without = example_arguments(spec);
      without.erase(argument.first);
      const std::string message = refused(spec, without);
      EXPECT_NE(message.find(argument.first), std::string::npos) << entry(spec.name, without) << " -> '" << message << "'";
      EXPECT_NE(message.find(spec.name), std::string::npos) << message;
    }
  }
}

TEST(EveryEffect, RefusesAValueOutOfBounds) {
  for (const EffectSpec& spec : effect_specs()) {
    for (const ParameterSpec& p : spec.parameters) {
      const double beyond = 0.1 * (p.upper - p.lower);
      for (const double value : {p.lower - beyond, p.upper + beyond}) {
        Arguments arguments = example_arguments(spec);
        arguments[p.name] = text(p, value);
        const std::string message = refused(spec, arguments);
        EXPECT_NE(message.find(spec.name + "." + p.name), std::string::npos)
            << entry(spec.name, arguments) << " -> '" << message << "'";
        EXPECT_NE(message.find("allowed"), std::string::npos) << message;
      }
      Arguments arguments = example_arguments(spec);
      arguments[p.name] = "soft";
      EXPECT_NE(refused(spec, arguments).find(spec.name + "." + p.name), std::string::npos) << spec.name;
    }
  }
}

TEST(EveryEffect, RefusesARegionThatIsNotThere) {
  int checked = 0;
  for (const EffectSpec& spec : effect_specs()) {
    for (const auto& key : spec.keys) {
      if (key.first != "region") continue;
      Arguments arguments = example_arguments(spec);
      arguments["region"] = "tail";
      const std::string message = refused(spec, arguments);
      EXPECT_NE(message.find("tail"), std::string::npos) << spec.name;
      EXPECT_NE(message.find("clamp"), std::string::npos) << "names no region that there is: " << message;
      ++checked;
    }
  }
  EXPECT_GE(checked, 4);
}

// Loads that are there from the start. A tool moves, and its ball is in the bar's upper side.
void feed(Model& model) {
  for (auto& [topic, course] : model.loads().courses()) {
    if (course->kind() != LoadInput::Kind::pose) {
      course->add(0.0, Eigen::VectorXd::LinSpaced(course->components(), 1.0, 2.0));
      continue;
    }
    for (int k = 0; k < 5; ++k) {
      const Eigen::AngleAxisd turn(0.3 + 0.02 * k, Eigen::Vector3d(1.0, 2.0, 3.0).normalized());
      course->add(0.05 * k, pose_values(Eigen::Translation3d(0.05 + 0.001 * k, 0.01, 0.029) * turn));
    }
  }
}

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

// Whoever implements an interface must hand it out: otherwise the model would never call it.
TEST(EveryEffect, HandsOutTheInterfacesThatItImplements) {
  const TetMesh mesh = bar_mesh(2);
  int more = 0;
  for (const EffectSpec& spec : effect_specs()) {
    const std::string law = fitting_law(spec);
    const Model model(box_settings(bar_with(spec.name, example_arguments(spec, law, "skin"), law)), mesh);
    const Effect* effect = model.parts().back().effect.get();
    EXPECT_EQ(effect->nonlinear_force(), dynamic_cast<const NonlinearForce*>(effect)) << spec.name;
    EXPECT_EQ(effect->contact(), dynamic_cast<const Contact*>(effect)) << spec.name;
    EXPECT_EQ(effect->finite_strain(), dynamic_cast<const FiniteStrainForm*>(effect)) << spec.name;
    EXPECT_EQ(effect->support(), dynamic_cast<const Support*>(effect)) << spec.name;
    EXPECT_EQ(effect->sensor_model(), dynamic_cast<const SensorModel*>(effect)) << spec.name;
    more += effect->sensor_model() != nullptr || effect->support() != nullptr ? 1 : 0;
  }
  EXPECT_GE(more, 6);
}

// The surface is closed, so that a follower pressure's tangent is symmetric and must match to the last entry.
TEST(EveryEffect, TangentEqualsFiniteDifferencesOfTheForce) {
  const TetMesh mesh = bar_mesh(2);
  const Eigen::VectorXd u = large_displacement(mesh);
  int nonlinear = 0;
  for (const EffectSpec& spec : effect_specs()) {
    if (!fits(spec, "neo_hookean")) continue;
    Model model(box_settings(bar_with(spec.name, example_arguments(spec, "neo_hookean", "skin"), "neo_hookean")), mesh);
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
    Model model(box_settings(bar_with(spec.name, example_arguments(spec, "neo_hookean", "skin"), "neo_hookean")), mesh);
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

// At least one parameter has a value that takes the effect away.
bool can_be_absent(const EffectSpec& spec) {
  bool found = false;
  for (const ParameterSpec& p : spec.parameters) {
    EXPECT_TRUE(std::isnan(p.absent) || (p.absent >= p.lower && p.absent <= p.upper)) << spec.name << "." << p.name;
    found = found || std::isfinite(p.absent);
  }
  return found;
}

Arguments absent_arguments(const EffectSpec& spec, const std::string& law) {
  Arguments arguments = example_arguments(spec, law);
  for (const ParameterSpec& p : spec.parameters) {
    if (std::isfinite(p.absent)) arguments[p.name] = text(p, p.absent);
  }
  return arguments;
}

// What a sensor sees of the swinging bar.
Eigen::VectorXd swing(const std::vector<std::string>& effects, const TetMesh& mesh, bool reduced = false) {
  Model model(box_settings(effects), mesh);
  feed(model);
  const Eigen::VectorXd theta = model.parameters().theta(model.parameters().prior_mean());
  FullModel::Options options;
  options.step = 0.002;
  std::unique_ptr<ForwardModel> forward = std::make_unique<FullModel>(model, options);
  if (reduced) forward = std::make_unique<ReducedModel>(model);
  const auto run = forward->start(theta, 0.0);
  run->advance(0.02 - model.sensors().delay(theta));
  const ObservedMotion seen = model.sensors().observe(theta, 0.02, run->displacement());
  Eigen::VectorXd all(seen.displacement.size() + 1);
  all << seen.displacement, seen.outward;
  return all;
}

TEST(EveryEffect, AtItsAbsentValueTheModelWithoutItComesBackBitForBit) {
  const TetMesh mesh = bar_mesh(3);
  for (const std::string law : {"linear", "neo_hookean"}) {
    const Eigen::VectorXd without = swing(bar_with("", {}, law), mesh);
    EXPECT_GT(without.norm(), 1e-4);
    int compared = 0;
    for (const EffectSpec& spec : effect_specs()) {
      if (!can_be_absent(spec) || !fits(spec, law)) continue;
      EXPECT_EQ(swing(bar_with(spec.name, absent_arguments(spec, law), law), mesh), without) << spec.name << ", " << law;
      EXPECT_NE(swing(bar_with(spec.name, example_arguments(spec, law), law), mesh), without)
          << spec.name << " does nothing at all";
      ++compared;
    }
    EXPECT_GE(compared, 9);
  }
}

TEST(EveryEffect, AtItsAbsentValueTheReducedModelIsTheSameToo) {
  const TetMesh mesh = bar_mesh(3);
  const Eigen::VectorXd without = swing(bar_with("", {}), mesh, true);
  int compared = 0;
  for (const EffectSpec& spec : effect_specs()) {
    if (!can_be_absent(spec) || !fits(spec, "linear")) continue;
    const Model model(box_settings(bar_with(spec.name, absent_arguments(spec, "linear"))), mesh);
    if (model.nonlinear()) continue;
    EXPECT_EQ(swing(bar_with(spec.name, absent_arguments(spec, "linear")), mesh, true), without) << spec.name;
    ++compared;
  }
  EXPECT_GE(compared, 9);
}

// The force is what the stored energy loses along a displacement.
TEST(EveryEffect, WithAnEnergyHasItsDerivativeForItsForce) {
  const TetMesh mesh = bar_mesh(2);
  const Eigen::VectorXd u = large_displacement(mesh), along = large_displacement(mesh).reverse(),
                        v = Eigen::VectorXd::Zero(u.size());
  int compared = 0;
  for (const EffectSpec& spec : effect_specs()) {
    if (!fits(spec, "neo_hookean")) continue;
    Model model(box_settings(bar_with(spec.name, example_arguments(spec, "neo_hookean", "skin"), "neo_hookean")), mesh);
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

TEST(LawOfFiniteStrain, IsRefusedAtSmallStrain) {
  int refused_laws = 0;
  for (const EffectSpec& spec : effect_specs()) {
    if (!spec.of_finite_strain) continue;
    const std::string message = refused(spec.name, example_arguments(spec), "linear");
    EXPECT_NE(message.find(spec.name), std::string::npos) << message;
    EXPECT_NE(message.find("neo_hookean"), std::string::npos) << message;
    ++refused_laws;
  }
  EXPECT_EQ(refused_laws, 3);
}

TEST(UnknownEffect, IsRefusedWithTheLibrary) {
  const std::string message = refused("elasticty", {});
  EXPECT_NE(message.find("elasticty"), std::string::npos);
  EXPECT_NE(message.find("viscous_damping"), std::string::npos) << message;
}

}  // namespace
}  // namespace tissue_stiffness
