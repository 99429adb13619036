#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

/// One effect of the library, assessed as the one that the model misses.
struct MissingEffect {
  std::string effect;
  std::string entry;                         ///< entry of the model file's list `effects`, as it was scored
  std::map<std::string, double> parameters;  ///< by name; from the refit where there was one, else from the tangent
  double log_bayes_factor = 0.0;             ///< of the effect with all its variants
  double p_value = 1.0;    ///< of the likelihood ratio with and without the effect; to first order where there was no refit
  double size = 0.0;       ///< rms of what the effect explains [sigma]
  double explained = 0.0;  ///< share of the residual's sum of squares that the effect explains
  double probability = 0.0;  ///< probability of all hypotheses with this effect; 0 without a refit
  double z = std::numeric_limits<double>::quiet_NaN();  ///< statistic of the residual's test, for the most probable one
  double held_out_rms_before = 0.0;                     ///< [m]
  double held_out_rms_after = std::numeric_limits<double>::quiet_NaN();  ///< [m]; NaN without a refit
  /// An effect whose tangent is nearly the same, with the cosine between both.
  struct Confusable {
    std::string effect;
    double cosine = 0.0;
  };
  std::vector<Confusable> confusable_with;
};

/// One model in the sequence from the given model to the proposed one.
struct DiagnosisStep {
  std::vector<std::string> effects;                               ///< effects added so far
  std::map<std::string, double> parameters;                       ///< values by name
  double train_rms = 0.0, held_out_rms = 0.0, noise_floor = 0.0;  ///< [m]
  /// Log evidence that the last of them gained when it was added; 0 of the given model.
  double log_bayes_factor = 0.0;
};

/// Parts of the free run's error: rms over all rows, either in [m] or in standard deviations.
struct ErrorParts {
  double total = 0.0, noise = 0.0;
  double numerical = 0.0;   ///< change with a finer mesh, without what the parameters can compensate
  double structured = 0.0;  ///< part beyond noise: sqrt(total^2 - noise^2)
};

/// The free run's error by time, node, amplitude, frequency and phase. Each rms is in standard deviations, so that 1 is
/// noise. Amplitude, frequency and phase are empty when the frames have different rows.
struct ResidualViews {
  std::vector<double> time, frame_rms;           ///< [s] since the first stamp, one entry a frame
  std::vector<int> nodes;                        ///< mesh nodes that were observed
  std::vector<double> node_rms;                  ///< one for each node
  std::vector<double> amplitude, amplitude_rms;  ///< upper end of each fifth of the frames, sorted by motion [m]
  std::vector<double> frequency, power;          ///< [Hz], and share of the error
  std::vector<double> phase, phase_rms;          ///< phase of the motion's strongest frequency [rad]
};

/// Where and when a model is valid. It is valid where its residual is noise or may be the mesh's error.
struct BeliefMap {
  std::vector<int> nodes;        ///< mesh nodes that were observed; empty: unknown
  std::vector<int> parts;        ///< part of the surface that each node belongs to
  Eigen::Matrix3Xd centres;      ///< centre of each part at rest [m]
  Eigen::MatrixX3d probability;  ///< that the model is valid on a part (row) in a third of the recording (column)
};

/// The additional force under which the model's free run would follow the recording. It is the smoothest such force in the
/// body's lowest modes.
struct MissingForce {
  std::vector<double> time;            ///< each frame but the first [s], since the first stamp; empty: no force is needed
  std::vector<Eigen::Vector3d> total;  ///< force on the whole body [N]
  std::vector<int> nodes;              ///< mesh nodes, spread over the surface
  Eigen::Matrix3Xd places;             ///< positions of these nodes at rest [m]
  std::vector<Eigen::Matrix3Xd> at_nodes;    ///< force per mass at these nodes in the interval before each frame [N/kg]
  std::map<std::string, double> parameters;  ///< parameters for which this force is missing, by name
  double explained = 0.0;                    ///< share of the residual's sum of squares, at these parameters
  /// Shares of its static work that a constant force, or one proportional to displacement or velocity, does.
  std::map<std::string, double> follows;
  std::string words;
};

/// The effect that explains most, or two effects that explain most together.
struct BestExplanation {
  std::vector<std::string> effects;  ///< empty: nothing was refitted
  double explained = 0.0;            ///< share of the residual's sum of squares that they explain
  double held_out_rms = std::numeric_limits<double>::quiet_NaN();  ///< [m]
};

/// Returns the effects of the `set` that are no part of the best explanation, and that fit as well.
std::vector<std::string> others_in_set(const std::vector<std::string>& set, const BestExplanation& best);

/// An explanation that the data cannot distinguish from the one that was added.
struct RivalExplanation {
  std::string effect;
  double probability = 0.0;  ///< relative to all explanations that cannot be distinguished
  /// Each Young's modulus with this explanation over the modulus with the added one, by name.
  std::map<std::string, double> modulus_ratio;
};

/// Result of comparing a model with its alternatives; judge() states the rule. `unfinished` means that the search was
/// interrupted before it had a verdict.
enum class Verdict { unfinished, adequate, missing, numerics, unexplained };
std::string to_string(Verdict verdict);

/// Which physics a model misses. Fields that are not known yet are empty or NaN.
struct Diagnosis {
  Verdict verdict = Verdict::unfinished;
  std::vector<std::string> set;  ///< the most probable effect, and those that the data cannot distinguish from it
  BestExplanation best;
  double adequate = std::numeric_limits<double>::quiet_NaN();  ///< probability of the given model
  double none_of_these =
      std::numeric_limits<double>::quiet_NaN();         ///< probability that no effect of the library explains the residual
  double z = std::numeric_limits<double>::quiet_NaN();  ///< statistic of the test of the given model's residual
  std::vector<MissingEffect> candidates;
  std::string where, when;
  ErrorParts metres, sigmas;
  ResidualViews residual;  ///< residual of the given model
  MissingForce force;      ///< force that the given model misses
  BeliefMap valid_given;   ///< validity of the given model
  BeliefMap valid_final;   ///< validity of the last step's model
  std::vector<DiagnosisStep> steps;
  std::string next_experiment;
  Verdict final_verdict = Verdict::unfinished;  ///< verdict on the last step's model
  std::vector<std::string> final_effects;
  std::vector<std::string> entries;                   ///< entries of the accepted effects for the model file
  std::vector<std::vector<RivalExplanation>> rivals;  ///< rivals of each accepted effect
  /// Effects that may act in addition to the last model without being missed. The test does not require them, but their
  /// evidence is in their favour.
  std::vector<RivalExplanation> traces;
  std::string left_out;  ///< how many frames were left out because a load was silent, and which; empty: none
  std::string failure;   ///< an effect that could not be added, or what is left could not be judged, and why; empty: none
  std::string interrupted;  ///< the step during which the work was interrupted; empty: the work was finished
  double seconds = 0.0;
  /// Estimate of the last step's model, mixed over rivals and traces. It is an estimator's, or the fit's own with state
  /// no_data.
  Estimate estimate;
};

}  // namespace tissue_stiffness
