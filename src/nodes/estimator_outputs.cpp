#include "tissue_stiffness/nodes/estimator_outputs.hpp"

#include <utility>

#include "tissue_stiffness/nodes/message_conversions.hpp"
#include "tissue_stiffness/nodes/surface_view.hpp"

namespace tissue_stiffness {

EstimatorOutputs::EstimatorOutputs(ros::NodeHandle node, std::string model_frame)
    : model_frame_(std::move(model_frame)),
      stiffness_(node.advertise<StiffnessEstimate>("stiffness", 100, true)),
      misfit_(node.advertise<MisfitMessage>("misfit", 100)),
      surface_(node.advertise<visualization_msgs::Marker>("tracked_surface", 10)),
      points_(node.advertise<sensor_msgs::PointCloud2>("tracked_points", 10)) {}

void EstimatorOutputs::publish(const Estimator& estimator, const StepResult& result, const Frame&,
                               const ros::Time& stamp) const {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = model_frame_;
  stiffness_.publish(to_message(result.estimate, header));
  misfit_.publish(to_message(result.misfit, header));
  if (surface_.getNumSubscribers() > 0) {
    surface_.publish(surface_marker(estimator.mesh(), estimator.displacement(), result.misfit, header));
  }
  if (points_.getNumSubscribers() > 0) {
    points_.publish(surface_cloud(estimator.mesh(), estimator.displacement(), result.misfit, header));
  }
}

}  // namespace tissue_stiffness
