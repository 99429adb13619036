#include "rviz/panel_state.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "report/effect_words.hpp"
#include "report/text.hpp"

namespace tissue_stiffness {
namespace {

constexpr char kModulus[] = "elasticity.young_modulus";

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns the effects of parameters that are named effect.parameter.
std::set<std::string> effects_of(const std::vector<std::string>& parameters) {
  std::set<std::string> out;
  for (const std::string& name : parameters) out.insert(name.substr(0, name.find('.')));
  return out;
}

std::string details(const MissingEffectMessage& effect) {
  std::string text = effect.entry;
  for (std::size_t i = 0; i < effect.parameter_names.size() && i < effect.parameter_values.size(); ++i) {
    text += "\n" + effect.parameter_names[i] + " = " + short_number(effect.parameter_values[i], 4);
  }
  text += "\nlog Bayes factor " + short_number(effect.log_bayes_factor, 3) + ", p = " + short_number(effect.p_value, 2);
  for (std::size_t i = 0; i < effect.confusable_with.size() && i < effect.cosines.size(); ++i) {
    text += "\nconfusable with " + effect_title(effect.confusable_with[i]) + " (cosine " +
            short_number(effect.cosines[i], 2) + ")";
  }
  return text;
}

std::string percent(double share) {
  return std::isfinite(share) ? std::to_string(std::lround(100.0 * share)) + " %" : "";
}

EffectRow row(const MissingEffectMessage& candidate, bool suspect) {
  EffectRow out;
  out.effect = candidate.effect;
  out.title = effect_title(candidate.effect);
  out.suspect = suspect;
  out.explained = std::clamp(candidate.explained, 0.0, 1.0);
  if (std::isfinite(candidate.held_out_rms_after)) {
    out.probability = percent(candidate.probability);
    out.error = short_number(1e3 * candidate.held_out_rms_before, 3) + " → " +
                short_number(1e3 * candidate.held_out_rms_after, 3) + " mm";
  }
  out.details = details(candidate);
  return out;
}

}  // namespace

void PanelState::take(const StiffnessEstimate& message) {
  const std::size_t count = std::min({message.names.size(), message.units.size(), message.mean.size(), message.std.size(),
                                      message.lower95.size(), message.upper95.size()});
  const std::set<std::string> before = estimated_ ? effects_of(estimate_.names) : std::set<std::string>{};
  estimate_ = message;
  estimated_ = count > 0;
  if (!estimated_) return;
  const auto found = std::find(message.names.begin(), message.names.end(), kModulus);
  const auto index = static_cast<std::size_t>(found - message.names.begin());
  shown_ = index < count ? index : 0;
  choose_unit(message.names[shown_], message.mean[shown_], message.units[shown_]);
  modulus_.add({message.header.stamp.toSec(), scale_ * message.mean[shown_], scale_ * message.lower95[shown_],
                scale_ * message.upper95[shown_]});
  if (!before.empty()) mark_changes(before, effects_of(message.names));
}

// The parameters show which effects changed in the running model, whoever changed them.
void PanelState::mark_changes(const std::set<std::string>& before, const std::set<std::string>& now) {
  std::string change;
  for (const std::string& effect : now) change += before.count(effect) == 0 ? " + " + effect_title(effect) : "";
  for (const std::string& effect : before) change += now.count(effect) == 0 ? " - " + effect_title(effect) : "";
  if (change.empty()) return;
  modulus_.mark(change.substr(1));
  misfit_curve_.mark(change.substr(1));
  model_changed_ = true;
}

// The unit stays while the numbers are easy to read, because a curve has one unit.
void PanelState::choose_unit(const std::string& name, double mean, const std::string& unit) {
  const double shown = std::abs(scale_ * mean);
  if (name == name_ && shown > 0.05 && shown < 5e4) return;
  const ShownUnit better = shown_unit(mean, unit);
  if (name != name_ || better.name != unit_) modulus_.clear();
  name_ = name;
  unit_ = better.name;
  scale_ = better.scale;
}

void PanelState::take(const MisfitMessage& message) {
  last_misfit_ = message;
  compared_ = true;
  const double millimetres = 1e3 * message.rms;
  misfit_curve_.add({message.header.stamp.toSec(), millimetres, millimetres, millimetres});
}

void PanelState::take(const DiagnosisMessage& message) {
  diagnosis_ = message;
  diagnosed_ = true;
  added_ = message.added;
}

void PanelState::set_added(const std::vector<std::string>& added) {
  added_ = added;
}

std::string PanelState::headline() const {
  if (!estimated_) return "-";
  const double half_width = 0.5 * scale_ * (estimate_.upper95[shown_] - estimate_.lower95[shown_]);
  return rounded(scale_ * estimate_.mean[shown_], half_width) + " " + unit_;
}

std::string PanelState::interval() const {
  if (!estimated_) return "";
  const double low = scale_ * estimate_.lower95[shown_], high = scale_ * estimate_.upper95[shown_];
  const double half_width = 0.5 * (high - low);
  return "95 %: " + rounded(low, half_width) + " to " + rounded(high, half_width) + " " + unit_;
}

std::string PanelState::quantity() const {
  if (!estimated_ || estimate_.names[shown_] == kModulus) return "Young's modulus";
  return estimate_.names[shown_];
}

std::string PanelState::modulus_axis() const {
  if (!estimated_) return "E";
  const std::string& name = estimate_.names[shown_];
  return (name == kModulus ? "E" : name.substr(name.find('.') + 1)) + (unit_.empty() ? "" : " [" + unit_ + "]");
}

Badge PanelState::state() const {
  static const std::map<std::string, Badge> badges{{"no_data", {"no data", 0x7a8088}},
                                                   {"converging", {"converging", 0x2f74c0}},
                                                   {"converged", {"converged", 0x2a8f57}},
                                                   {"doubtful", {"doubtful", 0xc77700}},
                                                   {"stale", {"stale", 0x7a8088}},
                                                   {"drifting", {"drifting", 0x7b4fb5}},
                                                   {"model_invalid", {"model invalid", 0xc0392b}}};
  if (!estimated_) return badges.at("no_data");
  const auto found = badges.find(estimate_.state);
  return found == badges.end() ? Badge{estimate_.state, 0x7a8088} : found->second;
}

std::string PanelState::misfit() const {
  if (!compared_) return "";
  return "misfit " + short_number(1e3 * last_misfit_.rms, 3) + " mm, " + short_number(last_misfit_.rms_sigma, 3) + " sigma";
}

Badge PanelState::verdict() const {
  static const std::map<std::string, Badge> badges{{"adequate", {"nothing", 0x2a8f57}},
                                                   {"missing", {"found", 0xc77700}},
                                                   {"numerics", {"adequate but for the numerics", 0x7a8088}},
                                                   {"unexplained", {"unexplained", 0xc0392b}}};
  if (!diagnosed_) return {"not diagnosed yet", 0x7a8088};
  if (stale()) return {"changed since the last diagnosis", 0x7a8088};
  const auto found = badges.find(diagnosis_.verdict);
  return found == badges.end() ? Badge{diagnosis_.verdict, 0x7a8088} : found->second;
}

std::vector<EffectRow> PanelState::rows() const {
  std::vector<EffectRow> out;
  for (const std::string& effect : added_) {
    EffectRow added;
    added.effect = effect;
    added.title = effect_title(effect);
    added.added = true;
    added.details = "added to the running model";
    out.push_back(added);
  }
  if (stale()) return out;
  for (const MissingEffectMessage& candidate : diagnosis_.candidates) {
    out.push_back(row(candidate, contains(diagnosis_.set, candidate.effect)));
  }
  if (!diagnosed_ || !std::isfinite(diagnosis_.none_of_these)) return out;
  EffectRow none;
  none.title = "none of these";
  none.probability = percent(diagnosis_.none_of_these);
  none.details = "something acts that the library does not have";
  out.push_back(none);
  return out;
}

std::string PanelState::best_candidate() const {
  if (stale()) return "";
  if (!diagnosis_.set.empty()) return diagnosis_.set.front();
  return diagnosis_.candidates.empty() ? "" : diagnosis_.candidates.front().effect;
}

double PanelState::noise_floor() const {
  return diagnosed_ ? 1e3 * diagnosis_.noise_floor : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace tissue_stiffness
