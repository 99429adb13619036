#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/stiffness_map.hpp"

namespace tissue_stiffness {

/// Whether the data determine a parameter. The verdict is "absolute", "ratio_only" or "none".
struct IdentifiabilityRecord {
  std::string verdict;
  std::string reason;
};

/// One frame of the run. Numbers that a skipped frame does not have are NaN.
struct FrameRecord {
  double time = 0.0;  ///< [s] on the recording's clock
  bool used = true;
  std::string reason;  ///< why the frame was skipped
  EstimateState state = EstimateState::no_data;
  std::string state_reason;                   ///< reason for the state
  std::vector<ParameterEstimate> parameters;  ///< the posterior after this frame, in the order of Results::parameters
  double misfit_rms = std::numeric_limits<double>::quiet_NaN();    ///< [m]
  double misfit_sigma = std::numeric_limits<double>::quiet_NaN();  ///< rms of error / sigma [-]
  double nis = std::numeric_limits<double>::quiet_NaN();
  int dof = 0;       ///< number of rows in `nis`
  int outliers = 0;  ///< number of rows whose weight is below one half
};

/// One of several recordings that were fitted together, or were predicted by such a fit.
struct RecordingRecord {
  std::string name;
  bool predicted = false;
  int frames = 0;
  EstimateState state_alone = EstimateState::no_data;                ///< by this recording alone
  std::vector<ParameterEstimate> alone;                              ///< by this recording alone; empty: predicted
  std::vector<ParameterEstimate> own;                                ///< parameters that only it has, by all recordings
  double rms_error = std::numeric_limits<double>::quiet_NaN();       ///< of the free run at the joint estimate [m]
  double noise_rms = std::numeric_limits<double>::quiet_NaN();       ///< as stated in the model file [m]
  double rms_sigma = std::numeric_limits<double>::quiet_NaN();       ///< rms error over sigma [-]
  double relative_error = std::numeric_limits<double>::quiet_NaN();  ///< rms error / rms motion [-]
  bool misfit_passes = false;
  double misfit_z = std::numeric_limits<double>::quiet_NaN();  ///< of the misfit's test; NaN: not tested
  bool agrees = false;
  double agreement_z = std::numeric_limits<double>::quiet_NaN();  ///< of the agreement with the others; NaN: not tested
  int agreement_dof = 0;
};

/// All results of an estimation run.
struct Results {
  std::string model;                          ///< name of the model file
  std::string recording;                      ///< name of the recording
  std::vector<ParameterEstimate> parameters;  ///< final estimates
  EstimateState state = EstimateState::no_data;
  std::string state_reason;              ///< reason for the state
  std::string interrupted;               ///< the step during which the run was interrupted; empty: it was finished
  std::vector<VarianceShares> variance;  ///< one for each parameter; empty: unknown
  std::vector<InputUncertainty> inputs;  ///< errors that the interval accounts for
  std::map<std::string, IdentifiabilityRecord> identifiable;         ///< by parameter name
  double rms_error = std::numeric_limits<double>::quiet_NaN();       ///< of the free run at the final estimate [m]
  double relative_error = std::numeric_limits<double>::quiet_NaN();  ///< rms error / rms motion [-]
  double noise_rms = std::numeric_limits<double>::quiet_NaN();    ///< noise of the sensors, as stated in the model file [m]
  double basis_error = std::numeric_limits<double>::quiet_NaN();  ///< of the reduced basis, an upper bound [m]
  double nis_mean_per_dof = std::numeric_limits<double>::quiet_NaN();
  double nis_p_value = std::numeric_limits<double>::quiet_NaN();
  int nodes = 0, tetrahedra = 0;            ///< of the mesh
  std::optional<StiffnessMap> map;          ///< if the model file asks for one
  std::vector<RecordingRecord> recordings;  ///< of several; `parameters` are then those that they share
  std::vector<FrameRecord> frames;
  std::vector<double> frame_seconds;                          ///< wall time of each used frame
  std::vector<std::pair<std::string, double>> stage_seconds;  ///< wall time of each stage over the whole run
  std::vector<std::string> description;                       ///< choices that the estimator made by itself
  std::string model_text;                                     ///< content of the model file
  std::string command_line;
  std::vector<std::pair<std::string, std::string>> versions;  ///< versions of the package and its libraries

  int used() const;
  int skipped() const;
  /// Returns the quantile 0 <= p <= 1 of frame_seconds by the nearest rank; NaN without frames.
  double frame_seconds_quantile(double p) const;
};

}  // namespace tissue_stiffness
