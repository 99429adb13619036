#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "tissue_stiffness/diagnosis/recording.hpp"
#include "tissue_stiffness/estimation/map_stiffness.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Topics `stiffness_map` (a Marker) and `stiffness_patches`, both latched. The map is made beside the frames, in a thread
/// of low priority on one core, whenever the run's frames have doubled; what goes wrong there is logged. All members are
/// called from one thread.
class MapPublisher {
 public:
  MapPublisher(ros::NodeHandle node, std::string model_frame);
  /// Gives up a map in progress and waits for its thread.
  ~MapPublisher() { give_up(); }
  MapPublisher(const MapPublisher&) = delete;
  MapPublisher& operator=(const MapPublisher&) = delete;

  /// From now on this model runs on this mesh; without `map` in it nothing is published.
  void start(const ModelSettings& settings, const TetMesh& mesh);
  /// Another run of the experiment.
  void start_lap();
  /// After each frame that was used. `recording` is called when a map is due.
  void add_frame(const Estimate& estimate, const std::function<Recording()>& recording);

 private:
  void give_up();
  void publish(const StiffnessMap& map, const TetMesh& mesh, double stamp) const;

  const std::string model_frame_;
  ros::NodeHandle node_;
  ros::Publisher marker_, patches_;
  ModelSettings settings_;
  TetMesh mesh_;
  std::size_t frames_ = 0, due_ = 0;
  std::shared_ptr<std::atomic<bool>> given_up_;  ///< of the map in progress
  std::future<void> work_;                       ///< last: its thread uses the members above
};

}  // namespace tissue_stiffness
