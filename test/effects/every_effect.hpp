#pragma once

#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "../box_model.hpp"
#include "effects/registry.hpp"
#include "forward/model.hpp"

namespace tissue_stiffness {

using Arguments = std::map<std::string, std::string>;

inline std::string text(double value) {
  std::ostringstream stream;
  stream.precision(17);
  stream << std::scientific << value;
  return stream.str();
}

/// A value of the parameter as YAML, repeated for a vector.
inline std::string text(const ParameterSpec& parameter, double value) {
  if (parameter.components == 1) return text(value);
  std::string list;
  for (int i = 0; i < parameter.components; ++i) list += (i > 0 ? ", " : "[") + text(value);
  return list + "]";
}

/// A value that does something on the bar, or one inside the bounds and away from their ends.
inline std::string example(const EffectSpec& spec, const ParameterSpec& parameter) {
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

/// Keys that an effect can do without say so.
inline bool optional(const std::string& meaning) {
  const auto says = [&](const char* words) { return meaning.find(words) != std::string::npos; };
  return says("without it") || says("instead of") || says("when absent");
}

inline bool optional(const ParameterSpec& parameter) {
  return parameter.presence == ParameterSpec::Default::optional;
}

/// Arguments that the spec accepts; keys that are no parameters are filled by what they are called everywhere.
inline Arguments example_arguments(const EffectSpec& spec, const std::string& law, const std::string& region = "tip") {
  Arguments arguments;
  for (const ParameterSpec& parameter : spec.parameters) {
    const bool idle = parameter.value == parameter.absent;  // what it does without saying so is nothing
    const bool shape = spec.name == "tool_contact" && parameter.name == "radius";  // needed where no file holds the tool
    if (!optional(parameter) || idle || shape) arguments[parameter.name] = example(spec, parameter);
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

inline std::string entry(const std::string& name, const Arguments& arguments) {
  std::string list;
  for (const auto& argument : arguments) list += (list.empty() ? "" : ", ") + argument.first + ": " + argument.second;
  return name + ": {" + list + "}";
}

/// A held bar that sags, with the effect in question in place of its namesake or behind the others.
inline std::vector<std::string> bar_with(const std::string& name, const Arguments& arguments,
                                         const std::string& law = "linear") {
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

/// Whether an effect goes with a law of the elasticity: finite strain on top of finite strain means nothing.
inline bool fits(const EffectSpec& spec, const std::string& law) {
  return law == "linear" ? !spec.of_finite_strain : spec.name != "geometric_nonlinearity";
}

inline std::string fitting_law(const EffectSpec& spec) {
  return fits(spec, "linear") ? "linear" : "neo_hookean";
}

inline Arguments example_arguments(const EffectSpec& spec) {
  return example_arguments(spec, fitting_law(spec));
}

/// Loads that are there from the start. A tool moves, and its ball is in the bar's upper side.
inline void feed(Model& model) {
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

}  // namespace tissue_stiffness
