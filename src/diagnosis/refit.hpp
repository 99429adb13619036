#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>

#include "diagnosis/candidates.hpp"
#include "diagnosis/model_comparison.hpp"

namespace tissue_stiffness {

/// A task is one candidate to be fitted, from the amplitude that its tangent has or from a known place.
struct RefitTask {
  const Candidate* candidate = nullptr;
  Eigen::VectorXd amplitude;
  std::map<std::string, double> start = {};  ///< by name, the others at their priors; empty: start from the tangent

  const std::string& effect() const { return candidate->effect; }
};

/// These limits keep the fits of one round short.
struct RefitLimits {
  double rival = no_rival;  ///< what another refit was `fitted` with: a fit that does not beat it may end early
  double least_gain = 0.0;  ///< [sigma^2] what a nonlinear model's first order explains before the model is run in full
  bool near_base = false;   ///< the base leaves noise, so no fit has to look for a place far from it
  FittedSteps steps = {};   ///< of the base
  double steps_rival = no_rival;  ///< likewise, of the fits with time steps
};

/// A refit is a fit of the base model with one proposal more.
struct Refit {
  std::string effect;
  const Candidate* candidate = nullptr;  ///< it was fitted with this one's entry `refine`; valid as long as its screening
  EffectEntry proposed;                  ///< it was fitted with this entry's priors
  EffectEntry entry;                     ///< for the model file: priors around the fit of the estimated parameters
  std::map<std::string, double> parameters;    ///< of the whole model, by name
  double held_out_rms = 0.0;                   ///< [m]
  double fitted = 0.0;                         ///< cost of the training frames and the prior
  double cost = 0.0;                           ///< sum of squared errors over sigma, all frames
  std::shared_ptr<const Explained> explained;  ///< the model as it is compared
  Assessment assessment;
  double log_bayes_factor = 0.0;       ///< beyond the given model, over all variants of the effect, of which one was fitted
  std::shared_ptr<FittedModel> model;  ///< null where it was only run quickly, and for all but the best
};

/// Fits the training frames by simulation, from the base's fit and the proposal's own starts. A nonlinear model is first
/// fitted at first order, which costs little. Throws NumericalError when no start can be run.
Refit refit_with(const FittedModel& base, const RefitTask& task, const RefitLimits& limits);

/// Fits a linear refit anew with a reduced basis that is chosen at its fit, and not at the proposal's prior. A lump of mass
/// that has moved by a part of its width, for example, is then seen more exactly. `steps`: of the base. The refit has to
/// have its model.
void choose_basis_at_fit(const FittedModel& base, const FittedSteps& steps, Refit& refit);

}  // namespace tissue_stiffness
