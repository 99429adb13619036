#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

/// What `estimate` left of one run, for a comparison.
struct ComparedRun {
  std::string name;  ///< its folder
  std::string model, model_text, recording, state, state_reason;
  int frames = 0;
  double rms_error = std::numeric_limits<double>::quiet_NaN(),
         noise_rms = std::numeric_limits<double>::quiet_NaN();  ///< [m]
  std::vector<ParameterEstimate> parameters;
  std::vector<double> time;                             ///< of the used frames, since the first of them [s]
  std::vector<double> misfit;                           ///< rms of each of these frames [m]
  std::vector<std::vector<double>> mean, lower, upper;  ///< one list a parameter, one number a frame
};

/// Reads the results.json and the estimates.csv of a run's folder. Throws InputError, naming the file and the key, for what
/// is missing.
ComparedRun read_run(const std::string& folder);

/// Returns one page that shows runs beside each other: parameters with their intervals, errors, states, both over time, and
/// how the model files differ from the first one. Each run is named by its folder, without the folders that all runs lie
/// in. It needs no network, and its text is complete without scripts. Throws InputError for a model that is no YAML.
std::string comparison_html(const std::vector<ComparedRun>& compared, const std::string& command_line,
                            const std::vector<std::pair<std::string, std::string>>& versions);

}  // namespace tissue_stiffness
