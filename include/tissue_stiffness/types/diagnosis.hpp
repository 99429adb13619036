#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

/// One effect of the library, judged as the one that the model misses.
struct MissingEffect {
  std::string effect;
  std::string entry;                         ///< of the model file's `effects`, as its proposal was scored
  std::map<std::string, double> parameters;  ///< by name, of the refit where there was one, else the tangent's
  double log_bayes_factor = 0.0;             ///< over all ways in which the effect may be missing
  double p_value = 1.0;      ///< of the likelihood ratio with it and without it; to first order where there was no refit
  double size = 0.0;         ///< rms of what it explains [sigma]
  double explained = 0.0;    ///< share of the residual's sum of squares
  double probability = 0.0;  ///< of the explanations that hold it; 0 without a refit
  double z = std::numeric_limits<double>::quiet_NaN();  ///< of the test of what the most probable of them leaves
  double held_out_rms_before = 0.0;                     ///< [m]
  double held_out_rms_after = std::numeric_limits<double>::quiet_NaN();  ///< [m]; NaN without a refit
  struct Twin {
    std::string effect;
    double cosine = 0.0;
  };
  std::vector<Twin> confusable_with;
};

/// A model on the way from the given one to the proposed one.
struct DiagnosisStep {
  std::vector<std::string> effects;                               ///< added so far
  std::map<std::string, double> parameters;                       ///< by name
  double train_rms = 0.0, held_out_rms = 0.0, noise_floor = 0.0;  ///< [m]
};

/// How much of the free run's error is what, rms over rows [m], and the same over sigma.
struct ErrorParts {
  double total = 0.0, noise = 0.0;
  double numerical = 0.0;   ///< what a finer mesh would change, of what the parameters cannot take up
  double structured = 0.0;  ///< beyond noise: root of total^2 - noise^2
};

/// The free run's error seen from several sides, rms over sigma; 1 is noise.
struct ResidualViews {
  std::vector<double> time, frame_rms;           ///< [s] since the first stamp, one entry a frame
  std::vector<int> nodes;                        ///< mesh nodes that were seen
  std::vector<double> node_rms;                  ///< one a node
  std::vector<double> amplitude, amplitude_rms;  ///< upper end of each fifth of the frames by motion [m]
  std::vector<double> frequency, power;          ///< [Hz], share of the error; empty when frames differ in their rows
  std::vector<double> phase, phase_rms;          ///< of the motion's strongest frequency [rad]; empty as above
};

/// Where and when a model is valid: what it leaves there is noise, or may be the mesh's error.
struct BeliefMap {
  std::vector<int> nodes;        ///< mesh nodes that were seen; empty: not known
  std::vector<int> parts;        ///< of the surface, that of each node
  Eigen::Matrix3Xd centres;      ///< of each part, at rest [m]
  Eigen::MatrixX3d probability;  ///< that the model is valid on a part (row) in a third of the recording (column)
};

/// What would have to act on the body, beside what the model knows, for its free run to be the recording: the smoothest
/// such force in the body's lowest modes.
struct MissingForce {
  std::vector<double> time;            ///< [s] since the first stamp, of each frame but the first; empty: none is needed
  std::vector<Eigen::Vector3d> total;  ///< on the whole body [N]
  std::vector<int> nodes;              ///< mesh nodes spread over the surface
  Eigen::Matrix3Xd places;             ///< of those, at rest [m]
  std::vector<Eigen::Matrix3Xd> at_nodes;    ///< force per mass there, of each frame since the one before [N/kg]
  std::map<std::string, double> parameters;  ///< that it is missing with, by name
  double explained = 0.0;                    ///< share of the sum of squares of the residual with them
  std::map<std::string, double> follows;  ///< share of its static work by a force proportional to each part of the motion
  std::string words;
};

/// What explains most: an effect, or two that are missing together.
struct BestExplanation {
  std::vector<std::string> effects;                                ///< empty: nothing was refitted
  double explained = 0.0;                                          ///< share of the residual's sum of squares
  double held_out_rms = std::numeric_limits<double>::quiet_NaN();  ///< [m]
};

/// An explanation that the data do not tell from the one that was added.
struct RivalExplanation {
  std::string effect;
  double probability = 0.0;                     ///< among those that are not told apart
  std::map<std::string, double> modulus_ratio;  ///< by a Young's modulus' name: with it, over with the added one
};

/// Which physics a model misses. `verdict`: adequate, missing, numerics, unexplained; unfinished where the search was
/// interrupted before it had one. What is not known then is empty or NaN.
struct Diagnosis {
  std::string verdict = "unfinished";
  std::vector<std::string> set;  ///< the winner and what the data cannot tell from it
  BestExplanation best;
  double adequate = std::numeric_limits<double>::quiet_NaN();  ///< probability of the given model
  double none_of_these =
      std::numeric_limits<double>::quiet_NaN();         ///< probability that no effect of the library explains it
  double z = std::numeric_limits<double>::quiet_NaN();  ///< of the test of the given model's residual
  std::vector<MissingEffect> candidates;
  std::string where, when;
  ErrorParts metres, sigmas;
  ResidualViews residual;  ///< of the given model
  MissingForce force;      ///< the same
  BeliefMap valid_given;   ///< the same
  BeliefMap valid_final;   ///< of the last step's model
  std::vector<DiagnosisStep> steps;
  std::string next_experiment;
  std::string final_verdict = "unfinished";  ///< of the last step
  std::vector<std::string> final_effects;
  std::vector<std::string> entries;                   ///< of the accepted effects, for the model file
  std::vector<std::vector<RivalExplanation>> rivals;  ///< of each accepted effect
  /// What may act beside the last model without being missed: the test asks for nothing more, but the evidence speaks for
  /// it.
  std::vector<RivalExplanation> traces;
  std::string interrupted;  ///< what was under way when the work was interrupted; empty: all was done
  double seconds = 0.0;
  Estimate
      estimate;  ///< of the last step's model: an estimator's; in state no_data the fit's own; mixed over rivals and traces
};

}  // namespace tissue_stiffness
