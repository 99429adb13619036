#include "tissue_stiffness/effects/proposal.hpp"

#include <algorithm>
#include <cstdio>

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

bool Proposal::is_other_kind_of(const Proposal& other) const {
  if (kind.empty() || kind == other.kind) return false;
  std::string text = refine;
  text.replace(text.find(kind), kind.size(), other.kind);
  return text == other.refine;
}

std::string yaml(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string yaml(const Eigen::Vector3d& v) {
  return "[" + yaml(v.x()) + ", " + yaml(v.y()) + ", " + yaml(v.z()) + "]";
}

std::string normal(double mean, double std) {
  return "{mean: " + yaml(mean) + ", std: " + yaml(std) + "}";
}

std::string normal(const Eigen::Vector3d& mean, double std) {
  return "{mean: " + yaml(mean) + ", std: " + yaml(std) + "}";
}

std::string log_normal(double median, double factor) {
  return "{prior: " + yaml(median) + ", factor: " + yaml(factor) + "}";
}

}  // namespace tissue_stiffness
