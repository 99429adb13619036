#include "estimation/identify.hpp"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "effects/registry.hpp"

namespace tissue_stiffness {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Returns whether a parameter carries the unit of force: the whole model scales with such parameters.
bool is_scale(const std::string& name) {
  for (const char* end : {".young_modulus", ".density", ".mass", ".scale", ".stiffness"}) {
    if (ends_with(name, end)) return true;
  }
  return false;
}

// Returns the names of the scales whose numbers the model file gives.
std::vector<std::string> known_scales(const Model& model) {
  std::vector<std::string> known;
  for (const ObservationSettings& observation : model.settings().observations) {
    if (traits_of(observation.kind).force) known.push_back("force on " + observation.topic);
  }
  for (const EffectSettings& effect : model.settings().effects) {
    for (const ParameterSpec& spec : effect_spec(effect).parameters) {
      const std::string name = effect.label + "." + spec.name;
      bool free = false;
      for (const FreeParameter& parameter : model.parameters().free()) free = free || parameter.name == name;
      if (is_scale(name) && !free && !effect_spec(effect).contact) known.push_back(name);
    }
  }
  return known;
}

// Returns each parameter's standard deviation over the prior's. When no scale is known the other scales are held, which
// tells what the data say about ratios.
Eigen::VectorXd narrowing(const Model& model, const Eigen::MatrixXd& covariance, bool ratios_only) {
  Eigen::VectorXd variance = covariance.diagonal();
  std::vector<Eigen::Index> scales;
  for (std::size_t i = 0; ratios_only && i < model.parameters().free().size(); ++i) {
    if (is_scale(model.parameters().free()[i].name)) scales.push_back(static_cast<Eigen::Index>(i));
  }
  if (scales.empty()) return variance.cwiseSqrt().cwiseQuotient(model.parameters().prior_std());
  const auto count = static_cast<Eigen::Index>(scales.size());
  Eigen::MatrixXd block(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      block(i, j) = covariance(scales[static_cast<std::size_t>(i)], scales[static_cast<std::size_t>(j)]);
    }
  }
  const Eigen::MatrixXd information = block.inverse();
  for (Eigen::Index i = 0; i < count; ++i) variance[scales[static_cast<std::size_t>(i)]] = 1.0 / information(i, i);
  return variance.cwiseSqrt().cwiseQuotient(model.parameters().prior_std());
}

}  // namespace

std::map<std::string, Identifiability> identify(const Model& model, const Eigen::MatrixXd& covariance) {
  std::map<std::string, Identifiability> result;
  const std::vector<std::string> known = known_scales(model);
  const Eigen::VectorXd narrowed = narrowing(model, covariance, known.empty()), ratios = narrowing(model, covariance, true);
  for (std::size_t i = 0; i < model.parameters().free().size(); ++i) {
    const std::string& name = model.parameters().free()[i].name;
    const auto k = static_cast<Eigen::Index>(i);
    const std::string percent = std::to_string(static_cast<int>(std::round(100.0 * narrowed[k])));
    if (narrowed[k] > learnt && ratios[k] <= learnt) {
      result[name] = {"ratio_only", "the data tell it over the other scales, but no force that they depend on is known"};
    } else if (narrowed[k] > learnt) {
      result[name] = {"none", "the data hardly narrow the prior: posterior standard deviation is " + percent + " % of it"};
    } else if (is_scale(name) && known.empty()) {
      result[name] = {"ratio_only", "no force, pressure, density or mass is known: all scale together"};
    } else {
      result[name] = {"absolute", is_scale(name) ? "scaled by the known " + known.front() : "no scale is involved"};
    }
  }
  return result;
}

}  // namespace tissue_stiffness
