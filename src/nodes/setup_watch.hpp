#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <mutex>
#include <set>
#include <string>

#include "check/setup_finding.hpp"
#include "nodes/diagnostics.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Logs each finding as a warning.
void warn_of(const SetupFindings& findings);

/// Reports errors of the estimator's set-up. It checks the numbers of the model file at the start. It checks for topics
/// that nobody publishes every 5 s until the first usable frame, and the mesh and the first frame when they arrive. Each
/// sentence is logged once. All of them are on /diagnostics under `set-up`, at level WARN until a frame is used. The node
/// is never stopped. Thread safe.
class SetupWatch {
 public:
  SetupWatch(ros::NodeHandle node, const ModelSettings& settings, Diagnostics& diagnostics);

  void mesh_came(const TetMesh& mesh);
  /// Must be called when a frame was used; only the first one is checked. `rest_time`: when the body was at rest [s].
  void frame_used(const Frame& frame, const TetMesh& mesh, double rest_time);

 private:
  void watch_topics();
  void say(const SetupFindings& findings);

  ros::NodeHandle node_;
  const ModelSettings settings_;
  Diagnostics& diagnostics_;
  std::atomic<bool> frame_seen_{false};
  std::mutex mutex_;  ///< protects `said_`
  std::set<std::string> said_;
  ros::WallTimer timer_;
};

}  // namespace tissue_stiffness
