#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/settings/value.hpp"

namespace tissue_stiffness {

/// An estimated vector. Each component has a normal prior about its mean, with the same standard deviation.
struct VectorPrior {
  Eigen::Vector3d mean;
  double std;
};

/// The value that a key of an effect may take: a text, a number, a vector, or an estimated quantity with its prior. Numbers
/// have the unit of the effect's spec. A Quantity is `normal` or `log_normal`, and has no drift.
struct Argument {
  Argument(const char* text);
  Argument(const std::string& text);
  Argument(double number);
  Argument(const Eigen::Vector3d& vector);
  Argument(const Quantity& prior);
  Argument(const VectorPrior& prior);
  // These are not inline: where GCC sees which alternative is copied, it warns that the others are not initialised.
  Argument(const Argument& other);
  Argument& operator=(const Argument& other);
  ~Argument();

  /// Returns whether the argument is exactly this text.
  bool is(const std::string& text) const;

  std::variant<std::string, double, Eigen::Vector3d, Quantity, VectorPrior> content;
};

/// These correspond to `{mean: mean, std: std}` and `{prior: median, factor: factor}`. The 1-sigma factor must be > 1.
Quantity normal_prior(double mean, double std);
VectorPrior normal_prior(const Eigen::Vector3d& mean, double std);
Quantity log_normal_prior(double median, double factor);

/// One entry of a model file's list `effects`, `name: {key: argument, ...}`. Numbers count to six significant digits, as
/// they are written to a file. So the entry and its text give the same model.
struct EffectEntry {
  std::string effect;
  std::vector<std::pair<std::string, Argument>> arguments;

  /// Returns the argument of this key, or null.
  const Argument* find(const std::string& key) const;
  /// Returns a copy that lacks the argument of this key.
  EffectEntry without(const std::string& key) const;
  /// Returns whether both entries have the same effect and the same arguments in the same order.
  bool same(const EffectEntry& other) const;
};

/// Converts the argument to the value that parse_yaml would read from its text.
Value to_value(const Argument& argument, const std::string& path);
/// Converts the entry to settings without a label.
EffectSettings to_settings(const EffectEntry& entry);
/// Appends the effect to the model's effects.
void add_effect(ModelSettings& model, const EffectEntry& entry);

/// Returns the text of a model file: `viscoelasticity: {gamma: {prior: 0.3, factor: 3}, tau: 0.1}`.
std::string to_yaml(const Argument& argument);
std::string to_yaml(const EffectEntry& entry);

}  // namespace tissue_stiffness
