#include "settings/effect_entry.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "types/formatted.hpp"

namespace tissue_stiffness {
namespace {

std::string shown(double value) {
  return formatted("%.6g", value);
}

std::string shown(const Eigen::Vector3d& v) {
  return "[" + shown(v.x()) + ", " + shown(v.y()) + ", " + shown(v.z()) + "]";
}

// Puts the text in quotes where YAML might read something else than this text.
std::string shown(const std::string& text) {
  const auto harmless = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == '/';
  };
  if (std::all_of(text.begin(), text.end(), harmless) && parse_yaml(text, "").type() == Value::Type::text) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

Value number(double value, const std::string& path) {
  return Value::number(std::strtod(shown(value).c_str(), nullptr), path);
}

Value vector(const Eigen::Vector3d& v, const std::string& path) {
  return Value::list({number(v.x(), path), number(v.y(), path), number(v.z(), path)}, path);
}

// Names the keys of a prior's value and spread.
std::pair<const char*, const char*> names(const Quantity& prior) {
  return prior.kind == Quantity::Kind::log_normal ? std::make_pair("prior", "factor") : std::make_pair("mean", "std");
}

struct Valued {
  const std::string& path;

  Value operator()(const std::string& text) const { return Value::text(text, path); }
  Value operator()(double value) const { return number(value, path); }
  Value operator()(const Eigen::Vector3d& v) const { return vector(v, path); }
  Value operator()(const Quantity& prior) const {
    const auto [value, spread] = names(prior);
    return Value::map({{value, number(prior.value, path)}, {spread, number(prior.spread, path)}}, path);
  }
  Value operator()(const VectorPrior& prior) const {
    return Value::map({{"mean", vector(prior.mean, path)}, {"std", number(prior.std, path)}}, path);
  }
};

struct Shown {
  std::string operator()(const std::string& text) const { return shown(text); }
  std::string operator()(double value) const { return shown(value); }
  std::string operator()(const Eigen::Vector3d& v) const { return shown(v); }
  std::string operator()(const Quantity& prior) const {
    const auto [value, spread] = names(prior);
    return std::string("{") + value + ": " + shown(prior.value) + ", " + spread + ": " + shown(prior.spread) + "}";
  }
  std::string operator()(const VectorPrior& prior) const {
    return "{mean: " + shown(prior.mean) + ", std: " + shown(prior.std) + "}";
  }
};

}  // namespace

Argument::Argument(const char* text) : content(std::string(text)) {}
Argument::Argument(const std::string& text) : content(text) {}
Argument::Argument(double number) : content(number) {}
Argument::Argument(const Eigen::Vector3d& vector) : content(vector) {}
Argument::Argument(const Quantity& prior) : content(prior) {}
Argument::Argument(const VectorPrior& prior) : content(prior) {}
Argument::Argument(const Argument& other) = default;
Argument& Argument::operator=(const Argument& other) = default;
Argument::~Argument() = default;

bool Argument::is(const std::string& text) const {
  const auto* own = std::get_if<std::string>(&content);
  return own != nullptr && *own == text;
}

Quantity normal_prior(double mean, double std) {
  return {Quantity::Kind::normal, mean, std};
}

VectorPrior normal_prior(const Eigen::Vector3d& mean, double std) {
  return {mean, std};
}

Quantity log_normal_prior(double median, double factor) {
  return {Quantity::Kind::log_normal, median, factor};
}

const Argument* EffectEntry::find(const std::string& key) const {
  const auto at = std::find_if(arguments.begin(), arguments.end(), [&](const auto& a) { return a.first == key; });
  return at == arguments.end() ? nullptr : &at->second;
}

EffectEntry EffectEntry::without(const std::string& key) const {
  EffectEntry rest{effect, {}};
  for (const auto& argument : arguments) {
    if (argument.first != key) rest.arguments.push_back(argument);
  }
  return rest;
}

bool EffectEntry::same(const EffectEntry& other) const {
  return effect == other.effect && to_settings(*this).arguments.same(to_settings(other).arguments);
}

Value to_value(const Argument& argument, const std::string& path) {
  return std::visit(Valued{path}, argument.content);
}

EffectSettings to_settings(const EffectEntry& entry) {
  const std::string path = "effect: " + entry.effect;
  std::vector<std::pair<std::string, Value>> map;
  for (const auto& [key, argument] : entry.arguments) map.emplace_back(key, to_value(argument, path + "." + key));
  return {entry.effect, "", Value::map(std::move(map), path)};
}

void add_effect(ModelSettings& model, const EffectEntry& entry) {
  add_effect(model, to_settings(entry));
}

std::string to_yaml(const Argument& argument) {
  return std::visit(Shown{}, argument.content);
}

std::string to_yaml(const EffectEntry& entry) {
  std::string text;
  for (const auto& [key, argument] : entry.arguments) {
    text += (text.empty() ? "" : ", ") + key + ": " + to_yaml(argument);
  }
  return entry.effect + ": {" + text + "}";
}

}  // namespace tissue_stiffness
