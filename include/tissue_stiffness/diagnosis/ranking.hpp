#pragma once

#include <map>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/candidates.hpp"

namespace tissue_stiffness {

/// One effect with the best of the ways in which it may be missing.
struct Ranked {
  std::string effect;
  const Candidate* best = nullptr;
  Score score;            ///< of the best way
  double evidence = 0.0;  ///< log-mean-exp of the log Bayes factors of all ways
  bool declared = false;  ///< evidence, p-value after multiplicity and size all speak for it
};

/// All effects that are proposed, most evidence first. `floor`: rms that the numerics may explain [sigma].
std::vector<Ranked> rank(const Scorer& scorer, const std::vector<Candidate>& candidates, double floor);

/// A fit of the base model with one proposal more.
struct Refit {
  std::string effect;
  std::string entry;                                 ///< for the model file: estimated parameters with their fit as prior
  std::map<std::string, double> parameters;          ///< of the whole model, by name
  double train_rms = 0.0, held_out_rms = 0.0;        ///< [m]
  double train_sigmas = 0.0, held_out_sigmas = 0.0;  ///< the same over sigma
  double cost = 0.0;                                 ///< sum of squared errors over sigma, all frames
  int added_parameters = 0;
};

/// Fits the training frames by full simulation, from the base's fit and the proposal's own start. Throws NumericalError
/// when no start can be run.
Refit refit(const Study& base, const Eigen::VectorXd& w, const Ranked& candidate);

}  // namespace tissue_stiffness
