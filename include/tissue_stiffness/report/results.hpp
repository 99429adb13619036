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

/// Whether the data determine a parameter: verdict "absolute", "ratio_only" or "none".
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
  std::string state_reason;                   ///< why it is so
  std::vector<ParameterEstimate> parameters;  ///< the posterior after this frame, in the order of Results::parameters
  double misfit_rms = std::numeric_limits<double>::quiet_NaN();    ///< [m]
  double misfit_sigma = std::numeric_limits<double>::quiet_NaN();  ///< rms of error / sigma [-]
  double nis = std::numeric_limits<double>::quiet_NaN();
  int dof = 0;       ///< rows in `nis`
  int outliers = 0;  ///< rows down-weighted below one half
};

/// Everything that an estimation run leaves behind.
struct Results {
  std::string model;                          ///< name of the model file
  std::string recording;                      ///< name of the recording
  std::vector<ParameterEstimate> parameters;  ///< final
  EstimateState state = EstimateState::no_data;
  std::string state_reason;              ///< why it is so
  std::string interrupted;               ///< what was under way when the run was interrupted; empty: it came to its end
  std::vector<VarianceShares> variance;  ///< of each parameter; empty: not known
  std::vector<InputUncertainty> inputs;  ///< errors that the interval counts
  std::map<std::string, IdentifiabilityRecord> identifiable;         ///< by parameter name
  double rms_error = std::numeric_limits<double>::quiet_NaN();       ///< of the free run at the final estimate [m]
  double relative_error = std::numeric_limits<double>::quiet_NaN();  ///< rms error / rms motion [-]
  double noise_rms = std::numeric_limits<double>::quiet_NaN();       ///< what the model file says about the sensors [m]
  double basis_error = std::numeric_limits<double>::quiet_NaN();     ///< of the reduced basis, an upper bound [m]
  double nis_mean_per_dof = std::numeric_limits<double>::quiet_NaN();
  double nis_p_value = std::numeric_limits<double>::quiet_NaN();
  std::optional<StiffnessMap> map;  ///< where the model file asks for one
  std::vector<FrameRecord> frames;
  std::vector<double> frame_seconds;                          ///< wall time of each used frame
  std::vector<std::pair<std::string, double>> stage_seconds;  ///< wall time of each stage over the whole run
  std::vector<std::string> description;                       ///< what the estimator chose by itself
  std::string model_text;                                     ///< the model file as it was read
  std::string command_line;
  std::vector<std::pair<std::string, std::string>> versions;  ///< of the package and its libraries

  int used() const;
  int skipped() const;
  /// Quantile 0 <= p <= 1 of frame_seconds by the nearest rank; NaN without frames.
  double frame_seconds_quantile(double p) const;
};

}  // namespace tissue_stiffness
