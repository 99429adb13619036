#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/candidates.hpp"

namespace tissue_stiffness {

/// One effect with the best of the ways in which it may be missing.
struct Ranked {
  std::string effect;
  const Candidate* best = nullptr;
  Score score;             ///< of the best way
  double evidence = 0.0;   ///< log-mean-exp of the log Bayes factors of all ways
  double p_value = 1.0;    ///< of none of the ways being there
  bool promising = false;  ///< evidence and size speak for it
  bool declared = false;   ///< and the p-value after multiplicity too
};

/// All effects that are proposed, most evidence first. `floor`: rms that the numerics may explain [sigma].
std::vector<Ranked> rank(const Scorer& scorer, const std::vector<Candidate>& candidates, double floor);

/// A way in which an effect may be missing, and how strongly as the tangents have it.
struct Addition {
  const Candidate* way = nullptr;
  Eigen::VectorXd amplitude;
  std::map<std::string, double> scanned = {};  ///< where a refit starts with what is neither amplitude nor the base's
  bool begun = false;  ///< `scanned` holds every parameter, as the recording's beginning has them (BeginningFit)
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

/// Two effects at once.
struct RankedPair {
  Addition first, second;
  double evidence = 0.0;  ///< log Bayes factor of both
  double gain = 0.0;      ///< beyond that of the better one alone
};

/// All pairs of effects, most evidence first. Every pair of the few best ways in which each
/// effect may be missing is scored.
std::vector<RankedPair> rank_pairs(const Scorer& scorer, const std::vector<Candidate>& candidates);

/// Sum of squared errors over sigma of a model fitted with what a simulated recording has of its time steps besides
/// (entries_of_simulation), and what the further parameters are worth after Schwarz; infinite where there are none.
struct CostBesideSteps {
  double cost = std::numeric_limits<double>::infinity();
  double beside_mesh = std::numeric_limits<double>::infinity();  ///< of what no share of the mesh's change explains either
};

/// A fit of the base model with one or two proposals more.
struct Refit {
  const Candidate* way = nullptr;  ///< of the first effect
  std::vector<std::string> effects;
  std::vector<std::string> proposals;                ///< entries that it was fitted with
  std::vector<std::string> entries;                  ///< for the model file: estimated parameters with their fit as prior
  std::map<std::string, double> parameters;          ///< of the whole model, by name
  double train_rms = 0.0, held_out_rms = 0.0;        ///< [m]
  double train_sigmas = 0.0, held_out_sigmas = 0.0;  ///< the same over sigma
  double p_value = 1.0;                              ///< of predicting the held-out frames no better
  double fitted = 0.0;                               ///< cost of the training frames and the prior
  double cost = 0.0;                                 ///< sum of squared errors over sigma, all frames
  double cost_beside_steps = 0.0;                    ///< the same, or what is left beside a simulation's time steps
  double cost_beside_numerics = 0.0;                 ///< of the latter what no share of the mesh's change explains
  std::optional<CostBesideSteps> beside_steps = {};  ///< what was found out; none before
  int added_parameters = 0;
  std::shared_ptr<Fitted> model;  ///< null where it was only run quickly, and of all but the best

  /// Lowers the two costs above to what was found out beside time steps.
  void allow_for_steps();
};

/// Fits the training frames by simulation, from the base's fit and the proposals' own starts: in full, but where
/// quick runs of a model that is not linear explain next to nothing. Throws NumericalError when
/// no start can be run. `mesh_change`: of the base's rows by a finer mesh [sigma]; an effect that imitates it has no
/// advantage. `rival`: what another refit was `fitted` with; where this one is no better it need not be the best.
Refit refit(const Fitted& base, const std::vector<Addition>& additions, const Eigen::VectorXd& mesh_change, double rival);

/// Of a linear refit's model, and of the base.
CostBesideSteps cost_beside_steps(const Fitted& base, const Refit& refit, const Eigen::VectorXd& mesh_change);
CostBesideSteps cost_beside_steps(const Fitted& base);

}  // namespace tissue_stiffness
