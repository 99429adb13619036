#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "report/results.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tools/paint.hpp"
#include "types/replay.hpp"
#include "types/stop_request.hpp"

namespace tissue_stiffness {

/// Results of an estimation run, and the time that it took.
struct EstimationRun {
  Results results;
  Showing showing;                                           ///< free run at the final estimate
  std::map<std::string, std::vector<double>> stage_samples;  ///< wall time of each stage in each frame that used it [s]
  double seconds = 0.0;                                      ///< wall time over all frames, including reading
  std::string map_vtk;                                       ///< empty if there is no map
  int late = 0;                                              ///< number of messages that came too late for their frame
  int broken_stamps = 0;                                     ///< number of messages left out for their stamps
  std::string last_broken_stamp;                             ///< topic and jump of the last one; empty: none
};

/// Called after each frame with the number of frames done and the largest possible total.
using ProgressCallback = std::function<void(std::size_t done, std::size_t total)>;

/// Runs the estimator over a recording, at most `max_frames` frames of it (0: all). Only wall times are not deterministic.
/// The model is that of the file `settings.name`. Throws InputError for a wrong model or recording, and when no frame could
/// be used.
///
/// When it is asked to stop, it ends after the present frame, without the free run and the map. The results are then the
/// last frame's and are marked as interrupted. Throws Interrupted if the first frame could not be read before.
EstimationRun estimate_recording(const ModelSettings& settings, const std::string& recording, std::size_t max_frames,
                                 const ProgressCallback& progress, const StopRequest& stop);

/// Prints the final table of `estimate`: parameters with interval and identifiability, error against noise, speed by stage.
void print_summary(const EstimationRun& run, const Paint& paint, std::ostream& out);

}  // namespace tissue_stiffness
