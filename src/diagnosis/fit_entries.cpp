#include "diagnosis/fit_entries.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

namespace tissue_stiffness {
namespace {

constexpr double kLeastFactor = 1.02;  // least factor of a log-normal prior
constexpr double kPriorWidth = 5.0;    // posterior standard deviations
constexpr double kRoom = 0.5;          // of the distance to a parameter's bound: largest width
constexpr double kLeastShare = 1e-3;   // of the model's own prior: smallest width

// A prior that reached beyond the parameter's bounds would have sigma points where no body can be.
double within_bounds(double width, const FreeParameter& p, double value) {
  return std::min(width, kRoom * std::min(value - p.lower, p.upper - value));
}

Quantity fitted(const FreeParameter& p, double at, double width) {
  if (p.prior.kind == Quantity::Kind::log_normal)
    return log_normal_prior(p.to_value(at), std::max(std::exp(std::min(width, 3.0)), kLeastFactor));
  return normal_prior(p.to_value(at), std::max(within_bounds(width, p, at), kLeastShare * p.prior.spread));
}

// `label` is that of the effect in the model.
void fit_entry(EffectEntry& entry, const std::string& label, const Model& model, const BatchFit& fit) {
  const std::vector<FreeParameter>& free = model.parameters().free();
  for (auto& [key, argument] : entry.arguments) {
    const bool vector = std::holds_alternative<VectorPrior>(argument.content);
    const std::string name = label + "." + key + (vector ? "_x" : "");
    const auto at = std::find_if(free.begin(), free.end(), [&](const FreeParameter& p) { return p.name == name; });
    if (at == free.end() || !(vector || std::holds_alternative<Quantity>(argument.content))) continue;
    const auto k = static_cast<Eigen::Index>(at - free.begin());
    const double width = kPriorWidth * std::sqrt(fit.covariance(k, k));
    if (vector) {
      argument = normal_prior(Eigen::Vector3d(fit.w.segment<3>(k)), std::max(width, kLeastShare * at->prior.spread));
    } else {
      argument = fitted(*at, fit.w[k], width);
    }
  }
}

}  // namespace

void fit_entries(std::vector<EffectEntry>& entries, const Model& model, const BatchFit& fit) {
  const std::vector<EffectSettings>& effects = model.settings().effects;
  auto effect = effects.end() - static_cast<std::ptrdiff_t>(entries.size());
  for (EffectEntry& entry : entries) fit_entry(entry, (effect++)->label, model, fit);
}

}  // namespace tissue_stiffness
