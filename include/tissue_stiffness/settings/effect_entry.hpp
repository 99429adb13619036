#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/settings/value.hpp"

namespace tissue_stiffness {

/// A vector that is estimated: each component is normal about its mean with the same standard deviation.
struct VectorPrior {
  Eigen::Vector3d mean;
  double std;
};

/// What a key of an effect may be given: a text, a number, a vector, or what is estimated with its prior. Numbers are in
/// the unit of the effect's spec. A Quantity is `normal` or `log_normal`, and has no drift.
struct Argument {
  Argument(const char* text);
  Argument(const std::string& text);
  Argument(double number);
  Argument(const Eigen::Vector3d& vector);
  Argument(const Quantity& prior);
  Argument(const VectorPrior& prior);
  // Not inline: where GCC sees which alternative is copied it warns that the others are not initialised.
  Argument(const Argument& other);
  Argument& operator=(const Argument& other);
  ~Argument();

  /// Just that text.
  bool is(const std::string& text) const;

  std::variant<std::string, double, Eigen::Vector3d, Quantity, VectorPrior> content;
};

/// `{mean: mean, std: std}` and, with the median and the 1-sigma factor > 1, `{prior: median, factor: factor}`.
Quantity normal(double mean, double std);
VectorPrior normal(const Eigen::Vector3d& mean, double std);
Quantity log_normal(double median, double factor);

/// One entry of a model file's `effects`, `name: {key: argument, ...}`. Its numbers count to six significant digits, those
/// that a file shows, so that the model of an entry is the one that is read from its text.
struct EffectEntry {
  std::string effect;
  std::vector<std::pair<std::string, Argument>> arguments;

  /// The argument of that key; null where there is none.
  const Argument* find(const std::string& key) const;
  /// The same but for the argument of that key.
  EffectEntry without(const std::string& key) const;
  /// Of the same effect and arguments, in the same order.
  bool same(const EffectEntry& other) const;
};

/// As parse_yaml would read its text.
Value to_value(const Argument& argument, const std::string& path);
/// The effect with its arguments, without a label.
EffectSettings to_settings(const EffectEntry& entry);
/// Appends the effect to the model's.
void add_effect(ModelSettings& model, const EffectEntry& entry);

/// As a model file has it: `viscoelasticity: {gamma: {prior: 0.3, factor: 3}, tau: 0.1}`.
std::string to_yaml(const Argument& argument);
std::string to_yaml(const EffectEntry& entry);

}  // namespace tissue_stiffness
