#include "estimation/resumed_model.hpp"

#include <algorithm>
#include <cmath>

#include "effects/registry.hpp"
#include "settings/effect_entry.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/body_size.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLength = 0.1;         // of the body's size: displacement at the beginning, 1 sigma
constexpr double kSpeed = 1.0;          // of the body's size a second
constexpr double kSecond = 0.1;         // of a displacement: that along the second shape
constexpr double kLeastFactor = 1.001;  // least factor of a log-normal prior

void require_known_loads(const ModelSettings& model) {
  for (EffectSettings effect : model.effects) {  // a copy: asking marks keys as known
    const char* const why =
        effect.arguments.has("course") ? "a load from a file" : "the pose of a moved region or of a tool";
    if (effect.arguments.has("course") || effect_spec(effect).load == LoadInput::Kind::pose) {
      throw InputError(effect.label, why, "loads on topics, where the body is not known to be at rest");
    }
  }
}

EffectEntry wide_motion(const TetMesh& mesh) {
  const double size = body_size(mesh.nodes);
  const auto prior = [](double std) { return Argument(normal_prior(Eigen::Vector3d(0.0, 0.0, 0.0), std)); };
  return {"initial_motion",
          {{"displacement", prior(kLength * size)},
           {"velocity", prior(kSpeed * size)},
           {"second_displacement", prior(kSecond * kLength * size)},
           {"second_velocity", prior(kSpeed * size)}}};
}

// Returns `map` with another value of a key.
Value with(const Value& map, const std::string& key, const Value& value) {
  std::vector<std::pair<std::string, Value>> entries;
  for (const std::string& name : map.keys()) entries.emplace_back(name, name == key ? value : map.at(name));
  return Value::map(std::move(entries), map.path());
}

// Returns the log-normal prior with the mean and the standard deviation of an estimate. It drifts as the one before did.
Value prior_of(const ParameterEstimate& known, const Value& before) {
  const double variance = std::log1p(std::pow(known.std / known.mean, 2));
  const double factor = std::max(std::exp(std::sqrt(variance)), kLeastFactor);
  const std::string& path = before.path();
  std::vector<std::pair<std::string, Value>> entries{{"prior", Value::number(known.mean * std::exp(-0.5 * variance), path)},
                                                     {"factor", Value::number(factor, path)}};
  if (before.has("drift")) entries.emplace_back("drift", before.at("drift"));
  return Value::map(std::move(entries), path);
}

}  // namespace

ModelSettings in_motion(ModelSettings model, const TetMesh& mesh) {
  require_known_loads(model);
  const auto moves = [](const EffectSettings& effect) { return effect.name == "initial_motion"; };
  if (std::none_of(model.effects.begin(), model.effects.end(), moves)) add_effect(model, wide_motion(mesh));
  model.initial = {};
  model.time.start = 0.0;
  return model;
}

void take_moduli(ModelSettings& model, const Estimate& known) {
  for (const ParameterEstimate& parameter : known.parameters) {
    if (!is_young_modulus(parameter.name)) continue;
    for (EffectSettings& effect : model.effects) {
      const std::string prefix = effect.label + ".";
      if (parameter.name.compare(0, prefix.size(), prefix) != 0) continue;
      const std::string key = parameter.name.substr(prefix.size());
      if (!effect.arguments.has(key) || !effect.arguments.at(key).has("prior")) continue;
      effect.arguments = with(effect.arguments, key, prior_of(parameter, effect.arguments.at(key)));
      model.known_before.push_back(parameter.name);
    }
  }
}

}  // namespace tissue_stiffness
