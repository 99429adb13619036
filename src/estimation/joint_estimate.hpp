#pragma once

#include <map>
#include <string>
#include <vector>

#include "estimation/agreement.hpp"
#include "estimation/joint_fit.hpp"
#include "estimation/misfit_test.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"
#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

/// What the joint estimate says of one recording.
struct RecordingSummary {
  std::string name;
  bool predicted = false;
  std::size_t frames = 0;
  Estimate alone;                                             ///< by this recording alone; of a predicted one it is empty
  double rms_error = 0.0, motion_rms = 0.0, noise_rms = 0.0;  ///< of the free run at the joint estimate [m]
  double lengths = 0.0;                                       ///< number of rows that are lengths
  double rms_sigma = 0.0;                                     ///< rms error over sigma [-]
  MisfitTest test;      ///< of a prediction: after the unknowns have moved within what is known of them
  Agreement agreement;  ///< with all other recordings
};

struct JointEstimate {
  Estimate estimate;
  std::vector<int> recording;  ///< the one that each parameter belongs to; -1: it is shared
  std::map<std::string, Identifiability> identifiable;
  std::vector<RecordingSummary> recordings;
  std::vector<std::string> description;
};

/// Estimates the parameters of a body from several recordings at once. Each is estimated alone; from there all are fitted
/// together (batch_fit), and mesh and inputs are studied together (input_study). So the prior counts once, and an error
/// that recordings share counts as one. Where recordings disagree by more than their errors allow, the covariance is
/// widened by as much (Birge 1932). Throws InputError as SharedParameters and Estimator do.
JointEstimate estimate_jointly(const std::vector<BodyRecording>& recordings, const std::vector<std::string>& own,
                               const JointProgress& progress);

}  // namespace tissue_stiffness
