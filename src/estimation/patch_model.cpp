#include "estimation/patch_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "effects/registry.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

[[noreturn]] void refuse(const Model& model, const std::string& found, const std::string& allowed) {
  throw InputError(model.settings().name + ": map", found, allowed);
}

Eigen::Index index_of(const Model& model, const std::string& parameter) {
  const auto& free = model.parameters().free();
  const auto at = std::find_if(free.begin(), free.end(), [&](const FreeParameter& p) { return p.name == parameter; });
  return at == free.end() ? -1 : at - free.begin();
}

// Returns the place among the effects of the elasticity whose modulus is estimated.
std::size_t mapped_effect(const Model& model) {
  const std::vector<EffectSettings>& effects = model.settings().effects;
  const std::string allowed = "one elasticity with `young_modulus: {prior, factor}`";
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    if (effects[i].name == "elasticity" && index_of(model, effects[i].label + ".young_modulus") >= 0) found.push_back(i);
  }
  if (found.empty()) refuse(model, "a model without an estimated young_modulus", allowed);
  if (found.size() > 1) refuse(model, "a model with several estimated moduli", allowed);
  return found.front();
}

Value patch_arguments(const Value& whole, const std::string& region, const Value& modulus) {
  std::vector<std::pair<std::string, Value>> entries;
  for (const std::string& key : whole.keys()) {
    if (key != "young_modulus" && key != "region") entries.emplace_back(key, whole.at(key));
  }
  entries.emplace_back("young_modulus", modulus);
  entries.emplace_back("region", Value::text(region, whole.path()));
  return Value::map(std::move(entries), whole.path());
}

}  // namespace

void require_map(const Model& model) {
  if (model.nonlinear()) {
    refuse(model, "a model that is not linear", "`law: linear` and effects that are linear in the displacement");
  }
  const std::string& label = model.settings().effects[mapped_effect(model)].label;
  const auto free = static_cast<std::size_t>(index_of(model, label + ".young_modulus"));
  const Quantity& prior = model.parameters().free()[free].prior;
  if (prior.kind != Quantity::Kind::log_normal) refuse(model, "young_modulus: {mean, std}", "`{prior, factor}`");
  if (prior.drift > 0.0) refuse(model, "a young_modulus with `drift`", "one that is constant");
  if (index_of(model, label + ".poisson_ratio") >= 0) refuse(model, "an estimated poisson_ratio", "a known number");
}

Patch mapped_tets(const Model& model) {
  return solid_elements(model.settings().effects[mapped_effect(model)].arguments, model.fem().element_count(),
                        model.body().regions);
}

PatchModel with_patches(const Model& model, const std::vector<Patch>& patches, const Eigen::VectorXd& log_modulus) {
  require_map(model);
  const std::size_t mapped = mapped_effect(model);
  const EffectSettings whole = model.settings().effects[mapped];
  PatchModel out{model.settings(), model.body().regions, index_of(model, whole.label + ".young_modulus"), 0.0, 0.0};
  const FreeParameter& common = model.parameters().free()[static_cast<std::size_t>(out.first)];
  out.common = common.prior_mean();
  out.common_std = common.prior_std();
  std::vector<EffectSettings> parts;
  for (std::size_t r = 0; r < patches.size(); ++r) {
    const std::string name = whole.label + " patch " + std::to_string(r + 1);
    out.regions[name].tets = patches[r];
    const std::string& path = whole.arguments.path();
    const Value median = Value::number(std::exp(log_modulus[static_cast<Eigen::Index>(r)]), path);
    const Value prior = Value::map({{"prior", median}, {"factor", Value::number(common.prior.spread, path)}}, path);
    parts.push_back({whole.name, name, patch_arguments(whole.arguments, name, prior)});
  }
  auto& effects = out.settings.effects;
  const auto at = effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(mapped));
  effects.insert(at, parts.begin(), parts.end());
  return out;
}

Eigen::MatrixXd patch_covariance(const PatchModel& patches, const Eigen::VectorXd& prior_std,
                                 const Eigen::MatrixXd& smooth) {
  Eigen::MatrixXd out = prior_std.cwiseAbs2().asDiagonal();
  const double common = patches.common_std * patches.common_std;
  out.block(patches.first, patches.first, smooth.rows(), smooth.cols()) = smooth.array() + common;
  return out;
}

}  // namespace tissue_stiffness
