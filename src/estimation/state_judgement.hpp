#pragma once

#include <string>
#include <vector>

#include "estimation/systematic_error.hpp"
#include "forward/model.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/misfit.hpp"

namespace tissue_stiffness {

constexpr double kInvalidSigmas = 10.0;  ///< rms error over noise at which the model says nothing about the body

/// The state of an estimate is judged by this evidence.
struct StateEvidence {
  const Model& model;
  const Misfit& misfit;               ///< of the present frame
  double misfit_scale;                ///< mean square of all frames' misfit over the noise's, at the present parameters
  bool misfit_has_risen;              ///< since it was tested
  bool change_suspected;              ///< the misfit has risen, and no change has been searched for yet
  bool invalid;                       ///< the free run has left the measurements for good
  std::string stale_load;             ///< a sentence; empty: no load is stale
  bool changing;                      ///< the parameters are modelled as moving
  bool restudying;                    ///< the inputs' errors are studied anew
  bool settled;                       ///< the estimate stays in its own interval
  bool mesh_pending;                  ///< the mesh's error will be known later
  double converged_within;            ///< relative standard deviation up to which the estimate may be converged
  const SystematicError& systematic;  ///< by the last studies
  const Eigen::MatrixXd& covariance;  ///< as published, filter coordinates
};

struct StateJudgement {
  EstimateState state;
  std::string reason;  ///< a sentence
};

/// Judges the state of an estimate; the table is in `doc/method/theory.md`.
StateJudgement judge_state(const StateEvidence& evidence);

/// Says how far a misfit is from passing its test.
std::string misfit_text(const MisfitTest& test);
/// Returns why an estimate is not precise enough to be used; empty: it is. `covariance` is that of filter coordinates, and
/// `widest` the relative standard deviation that it may have. A parameter that was `known_before` need not be better known
/// than its prior.
std::string unlearnt(const std::vector<FreeParameter>& free, const Eigen::MatrixXd& covariance, double widest,
                     const std::vector<std::string>& known_before = {});

}  // namespace tissue_stiffness
