#include "nodes/mesh_node.hpp"

#include <ros/ros.h>

#include <cmath>

#include "check/check_mesh.hpp"
#include "nodes/message_conversions.hpp"
#include "nodes/node_keys.hpp"
#include "nodes/sensor_conversions.hpp"
#include "nodes/setup_watch.hpp"
#include "segmentation/lens.hpp"
#include "settings/inside_folder.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

std::string counted(const TetMesh& mesh) {
  return std::to_string(mesh.node_count()) + " nodes, " + std::to_string(mesh.tet_count()) + " tetrahedra";
}

const KeySpec& key(const std::string& name) {
  return find_key(node_keys("mesh_node"), name);
}

}  // namespace

MeshNode::MeshNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
    : MeshNode(std::move(node), read_node_settings(private_node, names_of(node_keys("mesh_node")))) {}

MeshNode::MeshNode(ros::NodeHandle node, const NodeSettings& settings)
    : node_(std::move(node)),
      settings_(read_model(settings.model, settings.directory)),
      poses_(read_text(settings.own, key("model_frame")), read_number(settings.own, key("transform_timeout"))),
      folder_(read_text(settings.own, key("mesh_folder"))) {
  camera_info_topic_ = node_.resolveName("camera_info");
  for (const ObservationSettings& observation : settings_.observations) {
    if (observation.kind != ObservationKind::contour) continue;
    observation_ = observation;
    if (camera_info_topic_ == node_.resolveName("camera_info", false)) camera_info_topic_ = observation.camera_info;
    break;
  }
  const bool from_file = settings_.mesh.source == MeshSettings::Source::file;
  const auto on_listener = [this](const ros::SingleSubscriberPublisher&) {
    if (mesh_.empty()) await_contour();
  };
  publisher_ = from_file ? node_.advertise<TetMeshMessage>("mesh", 1, true)
                         : node_.advertise<TetMeshMessage>("mesh", 1, on_listener, ros::SubscriberStatusCallback(),
                                                           ros::VoidConstPtr(), true);
  build_service_ = node_.advertiseService("build_mesh", &MeshNode::on_build, this);
  save_service_ = node_.advertiseService("save_mesh", &MeshNode::on_save, this);
  if (!from_file) return;
  warn_of(check_mesh_file(settings_.mesh));  // before TetGen, which takes long over a mesh in mm
  publish(build_mesh(settings_.mesh));
}

void MeshNode::publish(const TetMesh& mesh) {
  mesh_ = mesh;
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = poses_.model_frame();
  publisher_.publish(to_message(mesh_, header));
  ROS_INFO("mesh: %s", counted(mesh_).c_str());
}

void MeshNode::await_contour() {
  if (contour_subscriber_) return;
  camera_info_subscriber_ = node_.subscribe(camera_info_topic_, 10, &MeshNode::on_camera_info, this);
  contour_subscriber_ = node_.subscribe("contour", 10, &MeshNode::on_contour, this);
  ROS_INFO("waiting for the first contour on %s", contour_subscriber_.getTopic().c_str());
}

// Only the first contour shows the body at rest. A later one is used if that one failed.
void MeshNode::on_contour(const ContourConstPtr& message) {
  if (!contour_) contour_ = message;
  build_from_contour();
}

void MeshNode::on_camera_info(const sensor_msgs::CameraInfoConstPtr& message) {
  camera_info_ = message;
  build_from_contour();
}

void MeshNode::build_from_contour() {
  if (!contour_ || !camera_info_) return;
  try {
    require_stamp(contour_->header, "contour");
    const Camera camera =
        to_camera(*camera_info_, observation_, poses_.model_from(contour_->header, "contour"), camera_info_topic_);
    Contour contour = to_contour(*contour_, "contour");
    undistort(camera, &contour);
    publish(build_mesh(settings_.mesh, contour, camera));
    contour_subscriber_.shutdown();
    camera_info_subscriber_.shutdown();
  } catch (const std::exception& error) {
    ROS_WARN("no mesh from this contour: %s", error.what());
  }
  contour_.reset();
}

bool MeshNode::on_build(BuildMesh::Request& request, BuildMesh::Response& response) {
  MeshSettings settings = settings_.mesh;
  try {
    for (const double value : {request.scale, request.max_edge_length}) {
      if (std::isfinite(value) && value >= 0.0) continue;
      throw InputError("build_mesh", "a scale or max_edge_length of " + std::to_string(value),
                       "finite numbers from 0; 0: as in the model");
    }
    if (request.scale > 0.0) settings.scale = request.scale;
    if (request.max_edge_length > 0.0) settings.max_edge_length = request.max_edge_length;
    if (!request.file.empty()) {
      settings.source = MeshSettings::Source::file;
      settings.file = require_inside(request.file, folder_.empty() ? settings_.directory : folder_, "build_mesh: file");
    }
    if (settings.source != MeshSettings::Source::file) {
      settings_.mesh = settings;
      await_contour();
      response.message = "building from the next contour";
    } else {
      publish(build_mesh(settings));
      response.nodes = static_cast<std::uint32_t>(mesh_.node_count());
      response.tetrahedra = static_cast<std::uint32_t>(mesh_.tet_count());
      response.message = counted(mesh_);
    }
    response.success = 1;
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

bool MeshNode::on_save(SaveMesh::Request& request, SaveMesh::Response& response) {
  try {
    if (mesh_.empty()) throw InputError("save_mesh", "no mesh yet", "a call after `mesh` was published");
    if (folder_.empty()) throw InputError("save_mesh", "no folder to save to", "a mesh node with ~mesh_folder");
    const std::string file = require_inside(request.file, folder_, "save_mesh: file");
    save_mesh(mesh_, file);
    response.success = 1;
    response.message = file + ": " + counted(mesh_);
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

}  // namespace tissue_stiffness
