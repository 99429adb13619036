#include "tissue_stiffness/settings/model_settings.hpp"

#include <algorithm>
#include <map>

#include "settings/key_spec.hpp"
#include "settings/read_sections.hpp"
#include "settings/suggestion.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

/// An entry is `- name: {...}`, or `- name` for an effect without keys.
EffectSettings read_effect(const Value& entry) {
  EffectSettings effect;
  if (entry.type() == Value::Type::text) {
    effect.name = entry.as_text();
    effect.arguments = Value::map({}, entry.path());
    return effect;
  }
  const std::vector<std::string> keys = entry.keys();
  if (keys.size() != 1) throw InputError(entry.path(), entry.shown(), "one effect an entry, `- name: {...}`");
  effect.name = keys.front();
  effect.arguments = entry.at(effect.name);  // copied unread: the effects layer asks for what it knows
  if (effect.arguments.type() == Value::Type::null) effect.arguments = Value::map({}, effect.arguments.path());
  if (effect.arguments.type() != Value::Type::map) {
    throw InputError(effect.arguments.path(), effect.arguments.shown(), "a map of the effect's keys");
  }
  entry.mark_read_deep();
  return effect;
}

std::vector<EffectSettings> read_effects(const Value& list) {
  std::vector<EffectSettings> effects;
  std::map<std::string, int> count;
  for (const Value& entry : list.items()) {
    EffectSettings effect = read_effect(entry);
    const int number = ++count[effect.name];
    effect.label = number == 1 ? effect.name : effect.name + "#" + std::to_string(number);
    effects.push_back(std::move(effect));
  }
  if (effects.empty()) throw InputError(list.path(), "an empty list", "at least one effect");
  return effects;
}

TimeSettings read_time(const Value& map) {
  TimeSettings time;
  time.start = read_number(map, find_key(model_keys(), "time.start"));
  time.step = read_number(map, find_key(model_keys(), "time.step"));
  return time;
}

InitialSettings read_initial(const Value& map) {
  InitialSettings initial;
  const Value& velocity = map.at("velocity");
  if (velocity.type() == Value::Type::text) {
    velocity.as_choice({"from_frames"});
    initial.kind = InitialSettings::Kind::from_frames;
  } else if (velocity.type() == Value::Type::list) {
    initial.kind = InitialSettings::Kind::velocity;
    initial.velocity = velocity.as_vector3("m/s");
  } else {
    throw InputError(velocity.path(), velocity.shown(), "[x, y, z] [m/s] or from_frames");
  }
  return initial;
}

MapSettings read_map(const Value& map) {
  MapSettings out;
  out.cells = read_integer(map, find_key(model_keys(), "map.cells"));
  out.length = read_number(map, find_key(model_keys(), "map.length"));
  out.factor = read_number(map, find_key(model_keys(), "map.factor"));
  return out;
}

/// A sensor can only belong to a region that exists.
void check_regions(const ModelSettings& model, const Value& observations) {
  std::vector<std::string> names;
  for (const RegionSettings& region : model.regions) names.push_back(region.name);
  for (std::size_t i = 0; i < model.observations.size(); ++i) {
    const std::string& region = model.observations[i].region;
    if (region.empty() || std::find(names.begin(), names.end(), region) != names.end()) continue;
    throw InputError(observations.items()[i].at(traits_of(model.observations[i].kind).name).at("region").path(),
                     "`" + region + "`" + did_you_mean(region, names), "the regions of this model: " + join_words(names));
  }
}

}  // namespace

ModelSettings read_model(const Value& root, const std::string& directory) {
  if (root.type() != Value::Type::map)
    throw InputError(root.path(), root.shown(), "a model: a map with mesh, effects, ...");
  ModelSettings model;
  model.name = root.path();
  model.directory = directory;
  model.mesh = read_mesh(root.at("mesh"), directory);
  if (root.has("regions")) model.regions = read_regions(root.at("regions"));
  model.effects = read_effects(root.at("effects"));
  model.observations = read_observations(root.at("observations"));
  if (root.has("time")) model.time = read_time(root.at("time"));
  if (root.has("initial")) model.initial = read_initial(root.at("initial"));
  model.estimator = read_choice(root, find_key(model_keys(), "estimator"));
  model.exact_inputs = read_choice(root, find_key(model_keys(), "inputs")) == "exact";
  model.stale_after = read_number(root, find_key(model_keys(), "stale_after"));
  model.window = read_integer(root, find_key(model_keys(), "window"));
  if (root.has("map")) model.map = read_map(root.at("map"));
  const bool forces = std::any_of(model.observations.begin(), model.observations.end(),
                                  [](const ObservationSettings& o) { return traits_of(o.kind).force; });
  if (forces && model.initial.kind == InitialSettings::Kind::from_frames) {
    throw InputError(root.at("initial").at("velocity").path(), "from_frames",
                     "a velocity, beside an observation `reaction`");
  }
  root.require_all_read();
  check_regions(model, root.at("observations"));
  return model;
}

void add_effect(ModelSettings& model, EffectSettings effect) {
  const auto same = [&](const EffectSettings& other) { return other.name == effect.name; };
  const auto number = std::count_if(model.effects.begin(), model.effects.end(), same) + 1;
  effect.label = number == 1 ? effect.name : effect.name + "#" + std::to_string(number);
  model.effects.push_back(std::move(effect));
}

void add_effect(ModelSettings& model, const std::string& entry) {
  add_effect(model, read_effect(parse_yaml(entry, "effect")));
}

void remove_effect(ModelSettings& model, const std::string& name) {
  const auto last = std::find_if(model.effects.rbegin(), model.effects.rend(),
                                 [&](const EffectSettings& effect) { return effect.name == name; });
  if (last == model.effects.rend()) {
    std::string names;
    for (const EffectSettings& effect : model.effects) names += (names.empty() ? "" : ", ") + effect.name;
    throw InputError("effect", name, "one of the model's: " + names);
  }
  model.effects.erase(std::next(last).base());
}

ModelSettings load_model(const std::string& file) {
  const std::size_t slash = file.find_last_of('/');
  return read_model(load_yaml(file), slash == std::string::npos ? "." : file.substr(0, slash + 1));
}

}  // namespace tissue_stiffness
