#include "nodes/estimator_outputs.hpp"

#include <map>
#include <utility>

#include "nodes/message_conversions.hpp"
#include "nodes/numbered_topic.hpp"
#include "nodes/surface_view.hpp"
#include "segmentation/lens.hpp"

namespace tissue_stiffness {

EstimatorOutputs::EstimatorOutputs(ros::NodeHandle node, std::string model_frame)
    : node_(node),
      model_frame_(std::move(model_frame)),
      stiffness_(node.advertise<StiffnessEstimate>("stiffness", 100, true)),
      misfit_(node.advertise<MisfitMessage>("misfit", 100)),
      surface_(node.advertise<visualization_msgs::Marker>("tracked_surface", 10)),
      points_(node.advertise<sensor_msgs::PointCloud2>("tracked_points", 10)),
      measured_(node.advertise<sensor_msgs::PointCloud2>("measured_points", 10)) {}

void EstimatorOutputs::prepare(const ModelSettings& settings, const TetMesh& mesh) {
  std::map<int, ModelOutline> outlines;
  std::size_t contours = 0;
  for (std::size_t i = 0; i < settings.observations.size(); ++i) {
    if (settings.observations[i].kind != ObservationKind::contour) continue;
    const int source = static_cast<int>(i);
    outlines.emplace(source, ModelOutline(settings, settings.observations[i], mesh));
    const std::string topic = numbered_topic("predicted_contour", ++contours);
    if (outline_topics_.count(source) == 0) outline_topics_[source] = node_.advertise<ContourMessage>(topic, 10);
  }
  outlines_ = std::move(outlines);
}

void EstimatorOutputs::publish(const Estimator& estimator, const StepResult& result, const Frame& frame,
                               const ros::Time& stamp) const {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = model_frame_;
  stiffness_.publish(to_message(result.estimate, header));
  misfit_.publish(to_message(result.misfit, header));
  if (surface_.getNumSubscribers() > 0) {
    surface_.publish(surface_marker(estimator.mesh(), estimator.displacement(), result.misfit, colour_limit_, header));
  }
  if (points_.getNumSubscribers() > 0) {
    points_.publish(surface_cloud(estimator.mesh(), estimator.displacement(), result.misfit, header));
  }
  if (measured_.getNumSubscribers() > 0) measured_.publish(measured_cloud(frame, header));
  publish_outline(estimator, frame, header);
}

void EstimatorOutputs::publish(const Estimate& estimate, const ros::Time& stamp) const {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = model_frame_;
  stiffness_.publish(to_message(estimate, header));
}

void EstimatorOutputs::publish_outline(const Estimator& estimator, const Frame& frame,
                                       const std_msgs::Header& header) const {
  for (const Observation& observation : frame.observations) {
    const auto outline = outlines_.find(observation.source);
    if (outline == outlines_.end() || outline_topics_.at(observation.source).getNumSubscribers() == 0) continue;
    const Eigen::Matrix3Xd positions = estimator.mesh().nodes + estimator.displacement();
    Contour seen = outline->second.seen_by(*observation.camera, positions);
    seen.points = distort(*observation.camera, seen.points);  // to lie over the camera's image
    outline_topics_.at(observation.source).publish(to_message(seen, header));
  }
}

}  // namespace tissue_stiffness
