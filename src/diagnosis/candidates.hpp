#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/scores.hpp"
#include "effects/proposal.hpp"
#include "fit/recording_fit.hpp"

namespace tissue_stiffness {

/// A candidate is one variant of an effect that may be missing, with its tangent: how the measured rows would change with
/// it.
struct Candidate {
  std::string effect;
  Proposal proposal;
  Tangent tangent;
  double absent = 0.0;                                      ///< parameter value that its amplitude is counted from
  double lower = -std::numeric_limits<double>::infinity();  ///< bounds of the amplitude
  double upper = std::numeric_limits<double>::infinity();
  bool linear = true;  ///< true: quick to refit
  /// The base at first order about its run in full, with all candidates, which the tangent was read from, and the index of
  /// its first parameter there; null: the tangent is that of the linear form.
  std::shared_ptr<const RecordingFit> linearised = {};
  Eigen::Index parameter = 0;

  /// Returns whether the amplitude is within its bounds: nothing is explained by a negative damping.
  bool allows(const Eigen::VectorXd& amplitude) const;
  /// Returns whether a parameter that it adds to a model is its amplitude. The effect has a number in that name where the
  /// model has another one of its kind (gravity#2.acceleration_x).
  bool has_amplitude(const std::string& parameter) const {
    return parameter.find("." + proposal.amplitude) != std::string::npos;
  }
};

/// The library holds the models that tangents were read from: one of the linear effects, and one of the others.
struct Library {
  std::shared_ptr<const RecordingFit> linear, others;
};

using CountProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Returns all that the effects propose for the fitted base model, except effects to `ignore`, without tangents.
std::vector<Candidate> propose_candidates(const RecordingFit& base, const Eigen::VectorXd& w,
                                          const std::vector<std::string>& ignore);

/// Reads the candidates' tangents. Those of all linear ones come from one reduced model that holds them all at their absent
/// values. Those of the others come from one at first order. A base that is not linear is linearised about its run in full
/// instead, and gives the tangents of all candidates that this suits; for the rest, what is not linear in it is left out.
/// `library` is that of an earlier round, or empty; it is replaced by that of this round. Its vectors are taken over; since
/// then the base may only have gained effects that leave the body's own mass and stiffness alone. `progress` hears how many
/// candidates are done, from any thread.
void read_tangents(const RecordingFit& base, const Eigen::VectorXd& w, std::vector<Candidate>& candidates,
                   const CountProgress& progress, Library& library);

/// Returns a fit that also has the time steps of a simulated recording, at their priors; null where the model allows for
/// them already. They need no vectors of their own.
std::unique_ptr<RecordingFit> with_time_steps(const RecordingFit& recording_fit, const Eigen::VectorXd& w);

/// Returns what the time steps of a simulated recording do to the rows of a model that does not allow for them. Each column
/// is for a prior standard deviation of the squared step [sigma]. There are no columns where the model has these steps.
Eigen::MatrixXd tangents_of_time_steps(const RecordingFit& recording_fit, const Eigen::VectorXd& w,
                                       const RecordingRows& rows);

/// Returns d rows / d w of the fitted base model, in sigmas: N x free parameters.
Eigen::MatrixXd base_tangents(const RecordingFit& base, const Eigen::VectorXd& w, const Eigen::VectorXd& std,
                              const RecordingRows& rows);

}  // namespace tissue_stiffness
