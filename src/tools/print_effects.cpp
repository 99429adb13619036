#include "tools/print_effects.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "effects/registry.hpp"
#include "report/text.hpp"

namespace tissue_stiffness {
namespace {

std::string bound(double value) {
  if (!std::isfinite(value) || std::abs(value) == std::numeric_limits<double>::max()) return value < 0.0 ? "-inf" : "inf";
  std::ostringstream out;
  out << (std::abs(value) == std::numeric_limits<double>::min() ? 0.0 : value);
  return out.str();
}

std::string range(const ParameterSpec& spec) {
  return "[" + bound(spec.lower) + ", " + bound(spec.upper) + "]";
}

std::string default_of(const ParameterSpec& spec) {
  return spec.presence == ParameterSpec::Default::required ? "required" : bound(spec.value);
}

std::string name_of(const ParameterSpec& spec) {
  return spec.name + (spec.components > 1 ? " [x, y, z]" : "");
}

std::string sentence(const std::string& text) {
  return capitalised(text) + ".";
}

/// Escapes the mark of a table, which a cell must not hold.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

}  // namespace

void print_effects(std::ostream& out) {
  for (const EffectSpec& effect : effect_specs()) {
    out << effect.name << ": " << effect.summary << "\n";
    out << "  formula   " << effect.formula << "\n";
    for (const ParameterSpec& spec : effect.parameters) {
      out << "  parameter " << name_of(spec) << " (" << spec.symbol << ") [" << spec.unit << "] in " << range(spec) << ", "
          << (spec.presence == ParameterSpec::Default::required ? "required" : "default " + bound(spec.value)) << "\n";
    }
    for (const auto& [key, meaning] : effect.keys) out << "  key       " << key << ": " << meaning << "\n";
    out << "  source    " << effect.source << "\n\n";
  }
}

void print_effects_markdown(std::ostream& out) {
  out << "# The library of effects\n\n`effects --markdown` writes this page. Every row comes from the effect's own "
         "specification.\n\n"
         "A parameter is a number, which is known, or estimated: `{prior: m, factor: f}` (log-normal: median, 1-sigma "
         "factor) or\n"
         "`{mean: m, std: s}` (normal). With `drift: d` it may change while the body moves, like a random walk: after t "
         "seconds\n"
         "the logarithm of the former, or the value of the latter, has changed by d sqrt(t) (1 sigma).\n";
  for (const EffectSpec& effect : effect_specs()) {
    out << "\n## `" << effect.name << "`\n\n"
        << sentence(effect.summary) << "\n\nFormula: `" << effect.formula << "`. Source: " << effect.source << ".\n";
    if (!effect.parameters.empty()) out << "\n| parameter | symbol | unit | allowed | default |\n|---|---|---|---|---|\n";
    for (const ParameterSpec& spec : effect.parameters) {
      out << "| `" << name_of(spec) << "` | " << cell(spec.symbol) << " | " << cell(spec.unit) << " | " << range(spec)
          << " | " << default_of(spec) << " |\n";
    }
    if (!effect.keys.empty()) out << "\n| key | takes |\n|---|---|\n";
    for (const auto& [key, meaning] : effect.keys) out << "| `" << key << "` | " << cell(meaning) << " |\n";
  }
}

void print_effect_names(std::ostream& out) {
  for (const EffectSpec& effect : effect_specs()) out << effect.name << "\n";
}

void print_effects_json(std::ostream& out) {
  nlohmann::json list = nlohmann::json::array();
  const auto finite = [](double value) {
    const bool none = !std::isfinite(value) || std::abs(value) == std::numeric_limits<double>::max();
    return none ? nlohmann::json() : nlohmann::json(value);
  };
  for (const EffectSpec& effect : effect_specs()) {
    nlohmann::json entry{{"name", effect.name},
                         {"summary", effect.summary},
                         {"formula", effect.formula},
                         {"source", effect.source},
                         {"parameters", nlohmann::json::array()},
                         {"keys", nlohmann::json::object()}};
    for (const ParameterSpec& spec : effect.parameters) {
      const bool required = spec.presence == ParameterSpec::Default::required;
      entry["parameters"].push_back({{"name", spec.name},
                                     {"symbol", spec.symbol},
                                     {"unit", spec.unit},
                                     {"components", spec.components},
                                     {"lower", finite(spec.lower)},
                                     {"upper", finite(spec.upper)},
                                     {"default", required ? nlohmann::json() : finite(spec.value)}});
    }
    for (const auto& [key, meaning] : effect.keys) entry["keys"][key] = meaning;
    list.push_back(entry);
  }
  out << list.dump(2) << "\n";
}

}  // namespace tissue_stiffness
