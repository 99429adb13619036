#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/candidates.hpp"
#include "tissue_stiffness/diagnosis/model_comparison.hpp"

namespace tissue_stiffness {

/// One effect with the best of the ways in which it may be missing.
struct Ranked {
  std::string effect;
  const Candidate* best = nullptr;
  Score score;            ///< of the best way
  double evidence = 0.0;  ///< log-mean-exp of the log Bayes factors of all ways
};

/// All effects that are proposed, most evidence first.
std::vector<Ranked> rank(const Scorer& scorer, const std::vector<Candidate>& candidates);

/// A way in which an effect may be missing, and how strongly as the tangents have it.
struct Addition {
  const Candidate* way = nullptr;
  Eigen::VectorXd amplitude;
  std::map<std::string, double> scanned = {};  ///< where a refit starts with what is neither amplitude nor the base's
  bool begun = false;  ///< `scanned` holds every parameter, as the recording's beginning has them (BeginningFit)

  const std::string& effect() const { return way->effect; }
};

/// A fit of the recording's beginning alone with one proposal more, looked for across its amplitude's whole prior. Phases
/// that drift apart hide the minimum from tangents and from fits of a whole recording, but not there.
struct BeginningFit {
  std::map<std::string, double> parameters;  ///< of the whole model, by name
  double deviance = 0.0;                     ///< sum of squared errors over sigma there, and Schwarz's for what was added
};
constexpr double kBeginning = 0.3;  // of the frames
/// Throws NumericalError when no start can be run.
BeginningFit fit_beginning(const Fitted& base, const Candidate& way);

/// A fit of the base model with one proposal more.
struct Refit {
  std::string effect;
  const Candidate* way = nullptr;              ///< whose entry `refine` it was fitted with; valid as long as its look
  EffectEntry entry;                           ///< for the model file: estimated parameters with their fit as prior
  std::map<std::string, double> parameters;    ///< of the whole model, by name
  double held_out_rms = 0.0;                   ///< [m]
  double fitted = 0.0;                         ///< cost of the training frames and the prior
  double cost = 0.0;                           ///< sum of squared errors over sigma, all frames
  std::shared_ptr<const Explained> explained;  ///< as it is compared
  Assessment assessment;
  std::shared_ptr<Fitted> model;  ///< null where it was only run quickly, and of all but the best
};

/// Fits the training frames by simulation, from the base's fit and the proposal's own starts: in full, but where quick runs
/// of a model that is not linear explain next to nothing. Throws NumericalError when no start can be run. `rival`: what
/// another refit was `fitted` with; where this one is no better it need not be the best.
Refit refit(const Fitted& base, const Addition& addition, double rival);

}  // namespace tissue_stiffness
