#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/scores.hpp"
#include "tissue_stiffness/diagnosis/study.hpp"
#include "tissue_stiffness/effects/proposal.hpp"

namespace tissue_stiffness {

/// One way in which one effect may be missing, and how the measured rows would change with it.
struct Candidate {
  std::string effect;
  Proposal proposal;
  Tangent tangent;
  double absent = 0.0;                                      ///< parameter value that its amplitude is counted from
  double lower = -std::numeric_limits<double>::infinity();  ///< bounds of the amplitude
  double upper = std::numeric_limits<double>::infinity();
  bool linear = true;  ///< quick to refit

  /// Within the bounds: nothing is explained by a negative damping.
  bool allows(const Eigen::VectorXd& amplitude) const;
};

/// The models that the tangents were read from: of what is linear, and of the others.
struct Library {
  std::shared_ptr<const Study> linear, others;
};

using CountProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Everything that the library proposes for the fitted base model, but for effects to `ignore`. The tangents of all linear
/// ones come from one reduced model that holds them all at their absent values, those of the others from one at first
/// order. What is not linear in the base is left out of it. `library`: that of an earlier look, from before the base had
/// effects that leave the body's own mass and stiffness alone, whose vectors are taken over, or empty; replaced by this
/// look's. `progress` hears how many of them are done, from any thread.
std::vector<Candidate> find_candidates(const Study& base, const Eigen::VectorXd& w, const std::vector<std::string>& ignore,
                                       const CountProgress& progress, Library& library);

/// Entries for the time steps of a simulated recording, which the model does not allow for.
std::vector<EffectEntry> entries_of_time_steps(const Study& study, const Eigen::VectorXd& w);

/// What the time steps of a simulated recording do to the rows of a model that does not allow for them: one column a
/// prior's standard deviation of the squared step [sigma]. No columns where the model has them.
Eigen::MatrixXd tangents_of_time_steps(const Study& study, const Eigen::VectorXd& w, const Study::Rows& rows);

/// d rows / d w of the fitted base model, in sigmas: N x free parameters.
Eigen::MatrixXd base_tangents(const Study& base, const Eigen::VectorXd& w, const Eigen::VectorXd& std,
                              const Study::Rows& rows);

}  // namespace tissue_stiffness
