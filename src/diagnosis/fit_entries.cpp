#include "tissue_stiffness/diagnosis/fit_entries.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tissue_stiffness/effects/proposal.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLeastFactor = 1.02;  // of a log-normal prior
constexpr double kPriorWidth = 5.0;    // posterior standard deviations
constexpr double kRoom = 0.5;          // of the distance to a parameter's bound: the most that they have
constexpr double kLeastShare = 1e-3;   // of the model's own prior: the least

// Where `key: {` begins among an entry's arguments; the effect's own name may end like a key.
std::size_t find_quantity(const std::string& entry, const std::string& key) {
  for (std::size_t at = entry.find(key + ": {"); at != std::string::npos; at = entry.find(key + ": {", at + 1)) {
    if (at > 0 && (entry[at - 1] == ' ' || entry[at - 1] == '{')) return at;
  }
  return std::string::npos;
}

// A prior that reaches beyond the parameter's bounds would have sigma points where no body can be.
double within_bounds(double width, const FreeParameter& p, double value) {
  return std::min(width, kRoom * std::min(value - p.lower, p.upper - value));
}

std::string fitted_entry(std::string entry, const std::string& label, const Model& model, const BatchFit& fit) {
  for (std::size_t i = 0; i < model.free_parameters().size(); ++i) {
    const FreeParameter& p = model.free_parameters()[i];
    if (p.name.rfind(label + ".", 0) != 0) continue;
    const std::string key = p.name.substr(label.size() + 1);
    const auto k = static_cast<Eigen::Index>(i);
    const double width = kPriorWidth * std::sqrt(fit.covariance(k, k));
    const bool vector = key.size() > 2 && key.compare(key.size() - 2, 2, "_x") == 0 && k + 2 < fit.w.size();
    const std::string name = vector ? key.substr(0, key.size() - 2) : key;
    const std::size_t at = find_quantity(entry, name);
    if (at == std::string::npos) continue;  // second and third components are written with the first
    if (vector) {
      const Eigen::Vector3d mean = fit.w.segment<3>(k);
      entry.replace(at, entry.find('}', at) + 1 - at,
                    name + ": " + normal(mean, std::max(width, kLeastShare * p.prior.spread)));
      continue;
    }
    const bool positive = p.prior.kind == Quantity::Kind::log_normal;
    const std::string quantity =
        positive ? log_normal(p.to_value(fit.w[k]), std::max(std::exp(std::min(width, 3.0)), kLeastFactor))
                 : normal(p.to_value(fit.w[k]), std::max(within_bounds(width, p, fit.w[k]), kLeastShare * p.prior.spread));
    entry.replace(at, entry.find('}', at) + 1 - at, key + ": " + quantity);
  }
  return entry;
}

}  // namespace

void fit_entries(std::vector<std::string>& entries, const Model& model, const BatchFit& fit) {
  const std::vector<EffectSettings>& effects = model.settings().effects;
  auto effect = effects.end() - static_cast<std::ptrdiff_t>(entries.size());
  for (std::string& entry : entries) entry = fitted_entry(std::move(entry), (effect++)->label, model, fit);
}

}  // namespace tissue_stiffness
