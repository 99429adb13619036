#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <tissue_stiffness/BuildMesh.h>
#include <tissue_stiffness/SaveMesh.h>

#include <string>

#include "nodes/messages.hpp"
#include "nodes/ros_settings.hpp"
#include "nodes/sensor_poses.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Builds the model's mesh and publishes it on `mesh` (latched). A mesh from a file is built immediately. A mesh from the
/// first `contour` with its `camera_info` and tf2 is built once there is a subscriber to `mesh`. The services are
/// `build_mesh` and `save_mesh`.
///
/// Private parameters: `model` (a file) or the model's keys; `model_frame` ("model"), `transform_timeout` (1 s),
/// `mesh_folder` ("": the services save nothing, and read from the model file's folder). Unless `camera_info` is remapped,
/// the topic is the model's.
class MeshNode {
 public:
  MeshNode(ros::NodeHandle node, const ros::NodeHandle& private_node);
  int exit_code() const { return exit_code_; }

 private:
  MeshNode(ros::NodeHandle node, const NodeSettings& settings);

  void await_contour();
  void on_contour(const ContourConstPtr& message);
  void on_camera_info(const sensor_msgs::CameraInfoConstPtr& message);
  void build_from_contour();
  void publish(const TetMesh& mesh);
  bool on_build(BuildMesh::Request& request, BuildMesh::Response& response);
  bool on_save(SaveMesh::Request& request, SaveMesh::Response& response);

  ros::NodeHandle node_;
  ModelSettings settings_;
  SensorPoses poses_;
  const std::string folder_;         ///< of the services' files; empty: none
  ObservationSettings observation_;  ///< the contour that the mesh comes from
  std::string camera_info_topic_;
  TetMesh mesh_;
  ContourConstPtr contour_;
  sensor_msgs::CameraInfoConstPtr camera_info_;
  int exit_code_ = 0;
  ros::Publisher publisher_;
  ros::Subscriber contour_subscriber_, camera_info_subscriber_;
  ros::ServiceServer build_service_, save_service_;
};

}  // namespace tissue_stiffness
