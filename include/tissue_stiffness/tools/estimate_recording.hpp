#pragma once

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "tissue_stiffness/report/results.hpp"
#include "tissue_stiffness/tools/paint.hpp"
#include "tissue_stiffness/types/replay.hpp"
#include "tissue_stiffness/types/stop_request.hpp"

namespace tissue_stiffness {

/// An estimation run: what it found, and how long it took.
struct EstimationRun {
  Results results;
  Showing showing;                                           ///< the free run at the final estimate
  std::map<std::string, std::vector<double>> stage_samples;  ///< wall time of each stage in each frame that used it [s]
  double seconds = 0.0;                                      ///< wall time over all frames, reading included
  std::string map_vtk;                                       ///< empty without a map
  int late = 0;                                              ///< messages that came too late for their frame
};

/// Called after each frame with the frames done and those there are at most.
using ProgressCallback = std::function<void(std::size_t done, std::size_t total)>;

/// Runs the estimator over a recording, at most `max_frames` frames of it (0: all). Deterministic but for wall times.
/// Throws InputError for a wrong model or recording, and when not a single frame could be used.
///
/// Asked to stop, it ends after the frame at hand, without the free run and the map: the results are the last frame's, and
/// marked as interrupted. Throws Interrupted where that was before the first frame could be read.
EstimationRun estimate_recording(const std::string& model_file, const std::string& recording, std::size_t max_frames,
                                 const ProgressCallback& progress, const StopRequest& stop);

/// The closing table of `estimate`: parameters with interval and identifiability, error against noise, speed by stage.
void print_summary(const EstimationRun& run, const Paint& paint, std::ostream& out);

}  // namespace tissue_stiffness
