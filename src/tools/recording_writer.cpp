#include "tools/recording_writer.hpp"

#include <cv_bridge/cv_bridge.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>

#include "segmentation/lens.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr auto kReal = sensor_msgs::PointField::FLOAT32;

std_msgs::Header header_of(const ros::Time& stamp, const std::string& frame) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = frame;
  return header;
}

sensor_msgs::CameraInfo info_of(const Camera& camera, const std_msgs::Header& header) {
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.distortion_model = lens_name(camera.lens);
  info.D.assign(5, 0.0);
  if (camera.lens != Camera::Lens::none)
    info.D.assign(camera.distortion.data(), camera.distortion.data() + camera.distortion.size());
  info.K = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

}  // namespace

RecordingWriter::RecordingWriter(const std::string& file) : file_(file) {
  try {
    bag_.open(file_.path(), rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw InputError(file, error.what(), "a file that can be written");
  }
  bag_.setCompression(rosbag::compression::BZ2);
}

void RecordingWriter::close() {
  bag_.close();
  file_.put_in_place();
}

void RecordingWriter::write_cloud(const std::string& topic, const ros::Time& stamp, const Eigen::Matrix3Xd& points,
                                  const Eigen::VectorXi& ids, const std::string& id_name) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header_of(stamp, "model");
  cloud.height = 1;
  cloud.is_dense = 1;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  if (id_name.empty()) {
    modifier.setPointCloud2Fields(3, "x", 1, kReal, "y", 1, kReal, "z", 1, kReal);
  } else {
    modifier.setPointCloud2Fields(4, "x", 1, kReal, "y", 1, kReal, "z", 1, kReal, id_name.c_str(), 1,
                                  sensor_msgs::PointField::INT32);
  }
  modifier.resize(static_cast<std::size_t>(points.cols()));
  sensor_msgs::PointCloud2Iterator<float> x(cloud, "x");
  for (Eigen::Index i = 0; i < points.cols(); ++i, ++x) {
    for (int axis = 0; axis < 3; ++axis) x[axis] = static_cast<float>(points(axis, i));
  }
  if (!id_name.empty()) {
    sensor_msgs::PointCloud2Iterator<std::int32_t> id(cloud, id_name);
    for (Eigen::Index i = 0; i < points.cols(); ++i, ++id) *id = ids[i];
  }
  bag_.write(topic, stamp, cloud);
}

void RecordingWriter::write_load(const LoadInput& input, const ros::Time& stamp, const Eigen::VectorXd& value) {
  if (input.kind == LoadInput::Kind::pressure) {
    sensor_msgs::FluidPressure pressure;
    pressure.header = header_of(stamp, "model");
    pressure.fluid_pressure = value[0];
    bag_.write(input.topic, stamp, pressure);
    return;
  }
  if (input.kind == LoadInput::Kind::pose) {
    geometry_msgs::PoseStamped pose;
    pose.header = header_of(stamp, "model");
    pose.pose.position.x = value[0];
    pose.pose.position.y = value[1];
    pose.pose.position.z = value[2];
    const Eigen::Quaterniond rotation(Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix3d>(value.data() + 3)));
    pose.pose.orientation.x = rotation.x();
    pose.pose.orientation.y = rotation.y();
    pose.pose.orientation.z = rotation.z();
    pose.pose.orientation.w = rotation.w();
    bag_.write(input.topic, stamp, pose);
    return;
  }
  geometry_msgs::WrenchStamped wrench;
  wrench.header = header_of(stamp, "model");
  wrench.wrench.force.x = value[0];
  wrench.wrench.force.y = value[1];
  wrench.wrench.force.z = value[2];
  wrench.wrench.torque.x = value[3];
  wrench.wrench.torque.y = value[4];
  wrench.wrench.torque.z = value[5];
  bag_.write(input.topic, stamp, wrench);
}

void RecordingWriter::write_image(const std::string& topic, const std::string& info_topic, const std::string& frame,
                                  const ros::Time& stamp, const Camera& camera, const cv::Mat& image) {
  const std_msgs::Header header = header_of(stamp, frame);
  bag_.write(info_topic, stamp, info_of(camera, header));
  bag_.write(topic, stamp, *cv_bridge::CvImage(header, image.channels() == 3 ? "bgr8" : "mono8", image).toImageMsg());
}

void RecordingWriter::write_pose(const std::string& frame, const ros::Time& stamp,
                                 const Eigen::Isometry3d& model_from_sensor) {
  geometry_msgs::TransformStamped pose;
  pose.header = header_of(stamp, "model");
  pose.child_frame_id = frame;
  const Eigen::Quaterniond rotation(model_from_sensor.linear());
  pose.transform.rotation.x = rotation.x();
  pose.transform.rotation.y = rotation.y();
  pose.transform.rotation.z = rotation.z();
  pose.transform.rotation.w = rotation.w();
  pose.transform.translation.x = model_from_sensor.translation().x();
  pose.transform.translation.y = model_from_sensor.translation().y();
  pose.transform.translation.z = model_from_sensor.translation().z();
  tf2_msgs::TFMessage message;
  message.transforms.push_back(pose);
  bag_.write("/tf_static", stamp, message);
}

}  // namespace tissue_stiffness
