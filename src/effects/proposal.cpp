#include "effects/proposal.hpp"

#include <algorithm>

namespace tissue_stiffness {

bool ProposalContext::holds(const std::string& effect) const {
  return !all(effect).empty();
}

std::vector<const EffectSettings*> ProposalContext::all(const std::string& effect) const {
  std::vector<const EffectSettings*> found;
  for (const EffectSettings& entry : settings.effects) {
    if (entry.name == effect) found.push_back(&entry);
  }
  return found;
}

bool ProposalContext::names(const std::string& effect, const std::string& region) const {
  const auto found = all(effect);
  return std::any_of(found.begin(), found.end(), [&](const EffectSettings* entry) {
    return entry->arguments.has("region") && entry->arguments.at("region").as_text() == region;
  });
}

std::vector<std::string> ProposalContext::regions_of(const std::string& acting, const std::string& absent) const {
  std::vector<std::string> regions;
  for (const EffectSettings* entry : all(acting)) {
    const std::string region = entry->arguments.at("region").as_text();
    if (!names(absent, region)) regions.push_back(region);
  }
  return regions;
}

bool ProposalContext::estimates(const std::string& effect, const std::string& parameter) const {
  const auto found = all(effect);
  return std::any_of(found.begin(), found.end(), [&](const EffectSettings* entry) {
    return entry->arguments.has(parameter) && entry->arguments.at(parameter).type() == Value::Type::map;
  });
}

bool ProposalContext::finite_strain() const {
  const auto elasticities = all("elasticity");
  return std::any_of(elasticities.begin(), elasticities.end(),
                     [](const EffectSettings* entry) { return entry->arguments.at("law").as_text() != "linear"; });
}

Eigen::Vector3d ProposalContext::low() const {
  return mesh.nodes.rowwise().minCoeff();
}

Eigen::Vector3d ProposalContext::high() const {
  return mesh.nodes.rowwise().maxCoeff();
}

double ProposalContext::size() const {
  return (high() - low()).norm();
}

bool ProposalContext::observes(ObservationSettings::Kind kind) const {
  return std::any_of(settings.observations.begin(), settings.observations.end(),
                     [kind](const ObservationSettings& entry) { return entry.kind == kind; });
}

std::string Proposal::kind() const {
  std::string out;
  for (const std::string& key : kind_keys) {
    const Argument* argument = refine.find(key);
    if (argument != nullptr) out += (out.empty() ? "" : " ") + to_yaml(*argument);
  }
  return out;
}

std::string Proposal::form() const {
  std::string out;
  for (const auto& [key, argument] : refine.arguments) out += (out.empty() ? "" : " ") + key;
  return out;
}

EffectEntry Proposal::with_given_shape() const {
  EffectEntry out = refine;
  for (auto& [key, argument] : out.arguments) {
    if (std::count(shape_keys.begin(), shape_keys.end(), key) > 0) argument = *entry.find(key);
  }
  return out;
}

bool Proposal::differs_in_start_from(const Proposal& other) const {
  if (refine.effect != other.refine.effect) return false;
  const EffectEntry own = with_given_shape(), others = other.with_given_shape();
  const auto alike = [](const auto& a, const auto& b) {
    const auto &x = a.second.content, &y = b.second.content;
    const bool starts = std::holds_alternative<Quantity>(x) || std::holds_alternative<VectorPrior>(x);
    return a.first == b.first && (starts ? x.index() == y.index() : to_yaml(a.second) == to_yaml(b.second));
  };
  return std::equal(own.arguments.begin(), own.arguments.end(), others.arguments.begin(), others.arguments.end(), alike);
}

bool Proposal::is_other_kind_of(const Proposal& other) const {
  if (kind_keys.empty() || kind() == other.kind()) return false;
  EffectEntry own = refine, others = other.refine;
  for (const std::string& key : kind_keys) {
    own = own.without(key);
    others = others.without(key);
  }
  return own.same(others);
}

}  // namespace tissue_stiffness
