#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/estimate_recording.hpp"
#include "tools/progress.hpp"

namespace tissue_stiffness {

/// A recording with its model file.
struct RecordingFile {
  std::string model, recording;
  bool predicted = false;
};

/// Reads MODEL RECORDING... [MODEL RECORDING...]: each recording belongs to the model file before it. Files that end in
/// .yaml or .yml are model files. Recordings before the first one belong to `model`. Throws InputError for a model file
/// without a recording.
std::vector<RecordingFile> pair_files(const std::vector<std::string>& files, std::string model, bool predicted);

/// Estimates what the recordings share. `own` names parameters, effects and topics that each recording has for itself. At
/// most `max_frames` frames of each recording are used (0: all). Throws InputError as estimate_recording does.
EstimationRun estimate_jointly(const std::vector<RecordingFile>& files, const std::vector<std::string>& own,
                               std::size_t max_frames, StepProgress& progress, const StopRequest& stop);

}  // namespace tissue_stiffness
