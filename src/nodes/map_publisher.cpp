#include "nodes/map_publisher.hpp"

#include <ros/console.h>

#include <chrono>
#include <utility>

#include "estimation/low_priority.hpp"
#include "nodes/map_view.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kFirst = 24;  // frames

}  // namespace

MapPublisher::MapPublisher(ros::NodeHandle node, std::string model_frame)
    : model_frame_(std::move(model_frame)), node_(std::move(node)) {}

void MapPublisher::give_up() {
  if (given_up_) *given_up_ = true;
}

void MapPublisher::start(const ModelSettings& settings, const TetMesh& mesh) {
  start_epoch();
  settings_ = settings;
  mesh_ = mesh;
  if (!settings.map || marker_) return;
  marker_ = node_.advertise<visualization_msgs::Marker>("stiffness_map", 1, true);
  patches_ = node_.advertise<StiffnessMapMessage>("stiffness_patches", 1, true);
}

void MapPublisher::start_epoch() {
  give_up();
  frames_ = 0;
  due_ = kFirst;
}

void MapPublisher::add_frame(const Estimate& estimate, const std::function<Recording()>& recording) {
  if (!settings_.map || ++frames_ < due_) return;
  if (work_.valid() && work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  due_ = 2 * frames_;
  Recording run = recording();
  const auto given_up = given_up_ = std::make_shared<std::atomic<bool>>(false);
  MapQuestion question{settings_, mesh_, std::move(run.frames), std::move(run.loads), run.first_stamp, estimate};
  question.checkpoint = [given_up] {
    if (*given_up) throw NumericalError("given up, because the run, the model or the node changed");
  };
  work_ = at_low_priority([this, given_up, question = std::move(question), stamp = estimate.time] {
    try {
      const StiffnessMap map = map_stiffness(question);
      if (!*given_up) publish(map, question.mesh, stamp);
    } catch (const std::exception& error) {
      if (!*given_up) ROS_WARN("no stiffness map: %s", error.what());
    }
  });
}

void MapPublisher::publish(const StiffnessMap& map, const TetMesh& mesh, double stamp) const {
  std_msgs::Header header;
  header.stamp.fromSec(stamp);
  header.frame_id = model_frame_;
  marker_.publish(map_marker(map, mesh, header));
  patches_.publish(to_message(map, header));
}

}  // namespace tissue_stiffness
