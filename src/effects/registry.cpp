#include "effects/registry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue_stiffness {

// Each effect's file defines these two.
namespace effects {
#define EFFECT(name)        \
  EffectSpec name##_spec(); \
  std::unique_ptr<Effect> make_##name(const Value& arguments, const EffectContext& context);
#include "effects/effects.def"
#undef EFFECT
}  // namespace effects

namespace {

using Maker = std::unique_ptr<Effect> (*)(const Value&, const EffectContext&);

const std::vector<Maker>& makers() {
  static const std::vector<Maker> list = {
#define EFFECT(name) &effects::make_##name,
#include "effects/effects.def"
#undef EFFECT
  };
  return list;
}

std::size_t index_of(const EffectSettings& settings) {
  const auto& specs = effect_specs();
  const auto at = std::find_if(specs.begin(), specs.end(), [&](const EffectSpec& s) { return s.name == settings.name; });
  if (at != specs.end()) return static_cast<std::size_t>(at - specs.begin());
  std::string names;
  for (const auto& spec : specs) names += (names.empty() ? "" : ", ") + spec.name;
  throw InputError(settings.arguments.path(), "effect '" + settings.name + "'", names);
}

Quantity default_value(const ParameterSpec& spec) {
  Quantity out{Quantity::Kind::known, spec.value, 0.0};
  out.tolerance = spec.tolerance;  // what nobody states is no better known
  return out;
}

// Reads {mean: [x, y, z], std: s} or {value: [x, y, z], tolerance: s}, with one spread for all axes.
void read_vector_with_spread(const Value& value, const ParameterSpec& spec, std::vector<Quantity>& out) {
  const bool known = value.has("value");
  const std::string middle = known ? "value" : "mean", spread = known ? "tolerance" : "std";
  const std::string allowed = "{mean: [x, y, z], std} or {value: [x, y, z], tolerance} in " + spec.unit;
  for (const std::string& key : value.keys()) {
    if (key != middle && key != spread) throw InputError(value.path(), value.shown(), allowed);
  }
  const std::vector<Value>& items = value.at(middle).items();
  if (static_cast<int>(items.size()) != spec.components) throw InputError(value.path(), value.shown(), allowed);
  const double least = known ? 0.0 : std::numeric_limits<double>::min();
  const double std = value.at(spread).as_number(least, 1e300, spec.unit);
  for (const Value& item : items) {
    Quantity quantity{known ? Quantity::Kind::known : Quantity::Kind::normal,
                      item.as_number(spec.lower, spec.upper, spec.unit), known ? 0.0 : std};
    if (known) quantity.tolerance = std;
    out.push_back(quantity);
  }
}

void read_vector(const Value& value, const ParameterSpec& spec, std::vector<Quantity>& out) {
  if (value.type() == Value::Type::map) return read_vector_with_spread(value, spec, out);
  const std::vector<Value>& items = value.items();
  if (static_cast<int>(items.size()) != spec.components) {
    throw InputError(value.path(), value.shown(), "[x, y, z] in " + spec.unit);
  }
  for (const Value& item : items) out.push_back(item.as_quantity(spec.lower, spec.upper, spec.unit));
}

}  // namespace

const std::vector<EffectSpec>& effect_specs() {
  static const std::vector<EffectSpec> list = {
#define EFFECT(name) effects::name##_spec(),
#include "effects/effects.def"
#undef EFFECT
  };
  return list;
}

const EffectSpec& effect_spec(const EffectSettings& settings) {
  return effect_specs()[index_of(settings)];
}

std::vector<Quantity> read_parameters(const EffectSettings& settings) {
  std::vector<Quantity> out;
  for (const ParameterSpec& spec : effect_spec(settings).parameters) {
    const bool optional = spec.presence == ParameterSpec::Default::optional;
    if (optional && !settings.arguments.has(spec.name)) {
      out.insert(out.end(), static_cast<std::size_t>(spec.components), default_value(spec));
      continue;
    }
    const Value& value = settings.arguments.at(spec.name);
    if (spec.components > 1) {
      read_vector(value, spec, out);
    } else {
      out.push_back(value.as_quantity(spec.lower, spec.upper, spec.unit));
    }
    for (auto quantity = out.end() - spec.components; quantity != out.end(); ++quantity) {
      if (quantity->tolerance < 0.0)
        quantity->tolerance = spec.tolerance + spec.tolerance_share * std::abs(quantity->value);
      // Two standard deviations stay within the bounds.
      const double room = std::min(spec.upper - quantity->value, quantity->value - spec.lower);
      quantity->tolerance = std::max(0.0, std::min(quantity->tolerance, 0.5 * room));
    }
  }
  return out;
}

std::unique_ptr<Effect> make_effect(const EffectSettings& settings, const EffectContext& context) {
  auto effect = makers()[index_of(settings)](settings.arguments, context);
  settings.arguments.require_all_read();
  return effect;
}

const Region& EffectContext::region(const Value& name) const {
  return find_region(name, regions);
}

const Region& find_region(const Value& name, const std::map<std::string, Region>& regions) {
  const std::string wanted = name.as_text();
  const auto at = regions.find(wanted);
  if (at != regions.end()) return at->second;
  std::string names;
  for (const auto& entry : regions) names += (names.empty() ? "" : ", ") + entry.first;
  throw InputError(name.path(), "region '" + wanted + "'", names.empty() ? "none: `regions` is empty" : names);
}

const Region& find_surface(const Value& name, const std::map<std::string, Region>& regions) {
  const Region& region = find_region(name, regions);
  if (region.facets.empty()) throw InputError(name.path(), name.shown(), "a region that holds boundary facets");
  return region;
}

}  // namespace tissue_stiffness
