#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "estimation/map_stiffness.hpp"
#include "tissue_stiffness/fit/recording.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Publishes the topics `stiffness_map` (a Marker) and `stiffness_patches`, both latched. The map is made in the
/// background, in a thread of low priority on one core, whenever the number of the run's frames has doubled. Errors there
/// are logged. All members must be called from one thread.
class MapPublisher {
 public:
  MapPublisher(ros::NodeHandle node, std::string model_frame);
  /// Cancels a map in progress and waits for its thread.
  ~MapPublisher() { give_up(); }
  MapPublisher(const MapPublisher&) = delete;
  MapPublisher& operator=(const MapPublisher&) = delete;

  /// Sets the running model and its mesh. Without `map` in the model nothing is published.
  void start(const ModelSettings& settings, const TetMesh& mesh);
  /// Starts another run of the experiment.
  void start_epoch();
  /// Must be called after each frame that was used. `recording` is called when a map is due.
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
  std::shared_ptr<std::atomic<bool>> given_up_;  ///< cancels the map in progress
  std::future<void> work_;                       ///< last member, because its thread uses the members above
};

}  // namespace tissue_stiffness
