#include "tissue_stiffness/effects/proposal.hpp"

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

bool ProposalContext::observes(ObservationSettings::Kind kind) const {
  return std::any_of(settings.observations.begin(), settings.observations.end(),
                     [kind](const ObservationSettings& entry) { return entry.kind == kind; });
}

std::string Proposal::kind() const {
  const Argument* argument = refine.find(kind_key);
  return argument == nullptr ? "" : to_yaml(*argument);
}

bool Proposal::is_other_kind_of(const Proposal& other) const {
  return !kind_key.empty() && kind() != other.kind() && refine.without(kind_key).same(other.refine.without(kind_key));
}

}  // namespace tissue_stiffness
