#pragma once

#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/nodes/messages.hpp"
#include "tissue_stiffness/rviz/live_curve.hpp"

namespace tissue_stiffness {

/// One line of the panel's list: an effect that was added to the running model, or one that it may miss, or none of these.
struct EffectRow {
  std::string effect;       ///< name in the library; empty: none of these
  std::string title;        ///< for people
  bool added = false;       ///< part of the running model, by add_effect
  bool suspect = false;     ///< the winner, or not to be told from it
  std::string probability;  ///< "94 %"; empty without a refit
  double explained = 0.0;   ///< share of the squared error [-]
  std::string error;        ///< "0.95 → 0.20 mm" on frames that no fit saw; empty without a refit
  std::string details;      ///< parameters, evidence and twins, one a line
};

/// A text and its colour 0xRRGGBB.
struct Badge {
  std::string text;
  unsigned colour = 0x808080;
};

/// What the panel shows, made of the estimator's messages. Knows nothing of Qt.
class PanelState {
 public:
  void take(const StiffnessEstimate& message);
  void take(const MisfitMessage& message);
  void take(const DiagnosisMessage& message);
  /// What the running model was given with add_effect, as list_effects says.
  void set_added(const std::vector<std::string>& added);
  /// True once after the running model's effects changed: who was added is to be asked then.
  bool model_changed() { return std::exchange(model_changed_, false); }
  void clear() { *this = PanelState(); }

  /// "12.02 kPa", of Young's modulus, or of the first parameter when none is estimated; "-" before the first frame.
  std::string headline() const;
  /// "95 %: 11.86 to 12.18 kPa"; empty before the first frame.
  std::string interval() const;
  /// Name of the quantity above, "Young's modulus".
  std::string quantity() const;
  Badge state() const;
  /// Why the state is so, a sentence; empty before the first frame.
  std::string state_reason() const { return estimated_ ? estimate_.state_reason : ""; }
  /// "misfit 0.210 mm, 1.02 sigma"; empty before the first frame.
  std::string misfit() const;
  Badge verdict() const;
  /// The diagnosis in a sentence; empty before there is one.
  std::string summary() const { return diagnosed_ && !stale() ? diagnosis_.summary : ""; }
  /// What was added, then what may be missing, best first; the latter only while the diagnosis is of the running model.
  std::vector<EffectRow> rows() const;
  /// What Add and Remove mean when nothing is selected; empty: nothing to add or remove.
  std::string best_candidate() const;
  std::string last_added() const { return added_.empty() ? "" : added_.back(); }

  const LiveCurve& modulus_curve() const { return modulus_; }  ///< [unit of the headline]
  const std::string& modulus_unit() const { return unit_; }
  const LiveCurve& misfit_curve() const { return misfit_curve_; }  ///< [mm]
  /// What noise alone would leave [mm]; NaN before a diagnosis.
  double noise_floor() const;

 private:
  void mark_changes(const std::set<std::string>& before, const std::set<std::string>& now);
  void choose_unit(const std::string& name, double mean, const std::string& unit);
  bool stale() const { return diagnosed_ && diagnosis_.added != added_; }

  bool estimated_ = false, compared_ = false, diagnosed_ = false, model_changed_ = false;
  StiffnessEstimate estimate_;
  MisfitMessage last_misfit_;
  DiagnosisMessage diagnosis_;
  std::vector<std::string> added_;
  std::size_t shown_ = 0;  ///< parameter of the headline
  double scale_ = 1.0;     ///< its unit in the shown one
  std::string name_, unit_;
  LiveCurve modulus_, misfit_curve_;
};

}  // namespace tissue_stiffness
