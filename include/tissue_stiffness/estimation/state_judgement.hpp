#pragma once

#include <string>

#include "tissue_stiffness/estimation/systematic_error.hpp"
#include "tissue_stiffness/forward/model.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/misfit.hpp"

namespace tissue_stiffness {

/// What the state of an estimate is judged by.
struct StateEvidence {
  const Model& model;
  const Misfit& misfit;               ///< of the present frame
  double misfit_scale;                ///< mean square of all frames' misfit over the noise's, present parameters
  bool change_suspected;              ///< the misfit has risen, and no change was searched for yet
  bool invalid;                       ///< the free run has left the measurements for good
  std::string stale_load;             ///< a sentence; empty: none is
  bool changing;                      ///< the parameters are modelled as moving
  bool restudying;                    ///< the inputs' errors are studied anew
  bool settled;                       ///< the estimate stays in its own interval
  bool mesh_pending;                  ///< the mesh's error will be known later
  const SystematicError& systematic;  ///< the last studies'
  const Eigen::MatrixXd& covariance;  ///< published, filter coordinates
};

struct StateJudgement {
  EstimateState state;
  std::string reason;  ///< a sentence
};

/// The state of an estimate: `doc/method/theory.md` has the table.
StateJudgement judge_state(const StateEvidence& evidence);

}  // namespace tissue_stiffness
