#pragma once

#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "nodes/messages.hpp"
#include "rviz/live_curve.hpp"

namespace tissue_stiffness {

/// One line of the panel's list: an effect that was added to the running model, an effect that it may miss, or "none of
/// these".
struct EffectRow {
  std::string effect;       ///< name in the library; empty: none of these
  std::string title;        ///< name for the user
  bool added = false;       ///< part of the running model because of add_effect
  bool suspect = false;     ///< the most probable effect, or not distinguishable from it
  std::string probability;  ///< "94 %"; empty without a refit
  double explained = 0.0;   ///< share of the squared error [-]
  std::string error;        ///< "0.95 → 0.20 mm" on held-out frames; empty without a refit
  std::string details;      ///< parameters, evidence and similar effects, one in each line
};

/// A text with a colour 0xRRGGBB.
struct Badge {
  std::string text;
  unsigned colour = 0x808080;
};

/// Content of the panel, made from the estimator's messages. It does not depend on Qt.
class PanelState {
 public:
  void take(const StiffnessEstimate& message);
  void take(const MisfitMessage& message);
  void take(const DiagnosisMessage& message);
  /// Sets the effects that add_effect added to the running model, as list_effects returns them.
  void set_added(const std::vector<std::string>& added);
  /// Returns true once after the running model's effects changed. The added effects must then be requested.
  bool model_changed() { return std::exchange(model_changed_, false); }
  void clear() { *this = PanelState(); }

  /// Returns "12.02 kPa" for Young's modulus, or for the first parameter when no modulus is estimated; "-" before the first
  /// frame.
  std::string headline() const;
  /// Returns "95 %: 11.86 to 12.18 kPa"; empty before the first frame.
  std::string interval() const;
  /// Returns the name of the quantity in headline(), "Young's modulus".
  std::string quantity() const;
  Badge state() const;
  /// Returns the reason for the state as a sentence; empty before the first frame.
  std::string state_reason() const { return estimated_ ? estimate_.state_reason : ""; }
  /// Returns "misfit 0.210 mm, 1.02 sigma"; empty before the first frame.
  std::string misfit() const;
  Badge verdict() const;
  /// Returns the diagnosis as a sentence; empty before there is one.
  std::string summary() const { return diagnosed_ && !stale() ? diagnosis_.summary : ""; }
  /// Returns the added effects, then those that may be missing, best first. The latter are returned only while the
  /// diagnosis is that of the running model.
  std::vector<EffectRow> rows() const;
  /// These return the effects that Add and Remove use when nothing is selected; empty: nothing to add or remove.
  std::string best_candidate() const;
  std::string last_added() const { return added_.empty() ? "" : added_.back(); }

  const LiveCurve& modulus_curve() const { return modulus_; }  ///< [unit of the headline]
  const std::string& modulus_unit() const { return unit_; }
  /// Returns the title of the curve's axis, "E [kPa]", or "beta [ms]" for another parameter.
  std::string modulus_axis() const;
  const LiveCurve& misfit_curve() const { return misfit_curve_; }  ///< [mm]
  /// Returns the rms that noise alone would leave [mm]; NaN before a diagnosis.
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
  std::size_t shown_ = 0;  ///< index of the headline's parameter
  double scale_ = 1.0;     ///< factor from its unit to the displayed one
  std::string name_, unit_;
  LiveCurve modulus_, misfit_curve_;
};

}  // namespace tissue_stiffness
