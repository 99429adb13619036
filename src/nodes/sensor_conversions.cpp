#include "nodes/sensor_conversions.hpp"

#include <cv_bridge/cv_bridge.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "tissue_stiffness/types/error.hpp"
#include "types/read_pose.hpp"

namespace tissue_stiffness {
namespace {

void require_finite(const Eigen::Ref<const Eigen::VectorXd>& values, const std::string& where) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) throw InputError(where, std::to_string(values[i]), "finite numbers");
  }
}

Eigen::Isometry3d to_isometry(const Eigen::Vector3d& position, const std::string& position_key,
                              const geometry_msgs::Quaternion& r, const std::string& rotation_key,
                              const std::string& topic) {
  const Eigen::Quaterniond rotation(r.w, r.x, r.y, r.z);
  require_finite(position, topic + ": " + position_key);
  return Eigen::Translation3d(position) * unit_rotation(rotation, topic + ": " + rotation_key);
}

void require_full_image(const sensor_msgs::CameraInfo& info, const std::string& topic) {
  if (info.width == 0 || info.height == 0) {
    throw InputError(topic + ": width x height", std::to_string(info.width) + " x " + std::to_string(info.height),
                     "the size of the image [pixel]");
  }
  if (info.binning_x > 1 || info.binning_y > 1) {
    throw InputError(topic + ": binning", std::to_string(info.binning_x) + ", " + std::to_string(info.binning_y), "0 or 1");
  }
  const auto& roi = info.roi;
  const bool whole = roi.x_offset == 0 && roi.y_offset == 0 && (roi.width == 0 || roi.width == info.width) &&
                     (roi.height == 0 || roi.height == info.height);
  if (!whole) throw InputError(topic + ": roi", "part of the image", "the full image");
}

void read_distortion(const sensor_msgs::CameraInfo& info, Camera* camera, const std::string& topic) {
  if (info.D.empty()) return;
  if (info.distortion_model != "plumb_bob") {
    throw InputError(topic + ": distortion_model", "'" + info.distortion_model + "'", "plumb_bob, or an empty D");
  }
  if (info.D.size() != 4 && info.D.size() != 5) {
    throw InputError(topic + ": D", std::to_string(info.D.size()) + " numbers", "k1 k2 p1 p2 and k3, or an empty D");
  }
  for (std::size_t i = 0; i < info.D.size(); ++i) camera->distortion[static_cast<Eigen::Index>(i)] = info.D[i];
  require_finite(camera->distortion, topic + ": D");
}

}  // namespace

std::string plain_frame(const std::string& frame) {
  return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
}

void require_stamp(const std_msgs::Header& header, const std::string& topic) {
  if (header.stamp.isZero()) throw InputError(topic + ": header.stamp", "0", "the time of the measurement");
}

Eigen::Isometry3d to_isometry(const geometry_msgs::Transform& transform, const std::string& topic) {
  const auto& t = transform.translation;
  return to_isometry({t.x, t.y, t.z}, "translation", transform.rotation, "rotation", topic);
}

Eigen::Isometry3d to_isometry(const geometry_msgs::Pose& pose, const std::string& topic) {
  const auto& p = pose.position;
  return to_isometry({p.x, p.y, p.z}, "pose.position", pose.orientation, "pose.orientation", topic);
}

Camera to_camera(const sensor_msgs::CameraInfo& info, ObservationSettings::Projection projection,
                 const Eigen::Isometry3d& model_from_sensor, const std::string& topic) {
  require_full_image(info, topic);
  Camera camera;
  camera.projection =
      projection == ObservationSettings::Projection::slice ? Camera::Projection::slice : Camera::Projection::pinhole;
  camera.width = static_cast<int>(info.width);
  camera.height = static_cast<int>(info.height);
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> k(info.K.data());
  require_finite(k, topic + ": K");
  if (!(k[0] > 0.0 && k[4] > 0.0)) {
    throw InputError(topic + ": K", "fx = " + std::to_string(k[0]) + ", fy = " + std::to_string(k[4]),
                     "focal lengths > 0 (calibrate the camera)");
  }
  camera.fx = k[0];
  camera.fy = k[4];
  camera.cx = k[2];
  camera.cy = k[5];
  read_distortion(info, &camera, topic);
  camera.model_from_sensor = model_from_sensor;
  return camera;
}

cv::Mat to_image(const sensor_msgs::ImageConstPtr& image, const std::string& topic) {
  static const std::array<const char*, 4> grey{"mono8", "8UC1", "mono16", "16UC1"};
  const std::string& encoding = image->encoding;
  const bool is_grey = std::find(grey.begin(), grey.end(), encoding) != grey.end();
  const bool is_plain = encoding == "8UC1" || encoding == "8UC3";  // no colour format to cv_bridge
  try {
    if (encoding == "16UC1") {
      cv::Mat narrow;
      cv_bridge::toCvShare(image)->image.convertTo(narrow, CV_8U, 1.0 / 256.0);
      return narrow;
    }
    const cv_bridge::CvImageConstPtr shared = cv_bridge::toCvShare(image, is_plain ? "" : is_grey ? "mono8" : "bgr8");
    if (shared->image.empty()) throw InputError(topic, "an empty image", "at least one pixel");
    return shared->image;
  } catch (const cv_bridge::Exception& error) {
    throw InputError(topic, "encoding '" + encoding + "' (" + error.what() + ")",
                     "mono8, mono16, bgr8, rgb8, bgra8, rgba8 or a Bayer pattern, with step * height bytes");
  } catch (const cv::Exception& error) {
    throw InputError(topic, "encoding '" + encoding + "' (" + error.err + ")", "an image that OpenCV can convert");
  }
}

cv::Mat to_image(const sensor_msgs::ImageConstPtr& image, SegmentationSettings::Kind kind, const std::string& topic) {
  if (kind != SegmentationSettings::Kind::mask) return to_image(image, topic);
  static const std::array<const char*, 4> allowed{"mono8", "8UC1", "mono16", "16UC1"};
  const char* const names = "mono8, 8UC1, mono16 or 16UC1 (a mask: 0 is background), with step * height bytes";
  const std::string& encoding = image->encoding;
  if (std::find(allowed.begin(), allowed.end(), encoding) == allowed.end()) {
    throw InputError(topic, "encoding '" + encoding + "'", names);
  }
  try {
    const cv::Mat values = cv_bridge::toCvShare(image)->image;
    if (values.empty()) throw InputError(topic, "an empty image", "at least one pixel");
    return values != 0;
  } catch (const cv_bridge::Exception& error) {
    throw InputError(topic, "encoding '" + encoding + "' (" + error.what() + ")", names);
  } catch (const cv::Exception& error) {
    throw InputError(topic, "an image that OpenCV refuses: " + error.err, names);
  }
}

LoadSample to_load(const sensor_msgs::FluidPressure& pressure, const std::string& topic) {
  LoadSample sample{topic, pressure.header.stamp.toSec(), Eigen::VectorXd::Constant(1, pressure.fluid_pressure)};
  require_finite(sample.value, topic + ": fluid_pressure");
  return sample;
}

LoadSample to_load(const geometry_msgs::WrenchStamped& wrench, const Eigen::Isometry3d& model_from_sensor,
                   const std::string& topic) {
  const auto& force = wrench.wrench.force;
  const auto& torque = wrench.wrench.torque;
  LoadSample sample{topic, wrench.header.stamp.toSec(), Eigen::VectorXd(6)};
  sample.value << model_from_sensor.linear() * Eigen::Vector3d(force.x, force.y, force.z),
      model_from_sensor.linear() * Eigen::Vector3d(torque.x, torque.y, torque.z);
  require_finite(sample.value, topic + ": wrench");
  return sample;
}

LoadSample to_load(const geometry_msgs::PoseStamped& pose, const Eigen::Isometry3d& model_from_sensor,
                   const std::string& topic) {
  return {topic, pose.header.stamp.toSec(), pose_values(model_from_sensor * to_isometry(pose.pose, topic))};
}

Observation to_reaction(const geometry_msgs::WrenchStamped& wrench, int source, const Eigen::Isometry3d& model_from_sensor,
                        const std::string& topic) {
  const LoadSample load = to_load(wrench, model_from_sensor, topic);
  Observation out;
  out.source = source;
  out.kind = ObservationKind::reaction;
  out.time = load.time;
  out.points = load.value.head<3>();
  return out;
}

}  // namespace tissue_stiffness
