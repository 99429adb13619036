#include "nodes/sensor_conversions.hpp"

#include <cv_bridge/cv_bridge.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "segmentation/lens.hpp"
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

void read_focal_lengths(double fx, double fy, double cx, double cy, const std::string& where, Camera* camera) {
  require_finite(Eigen::Vector4d(fx, fy, cx, cy), where);
  if (!(fx > 0.0 && fy > 0.0)) {
    throw InputError(where, "fx = " + std::to_string(fx) + ", fy = " + std::to_string(fy),
                     "focal lengths > 0 (calibrate the camera)");
  }
  camera->fx = fx;
  camera->fy = fy;
  camera->cx = cx;
  camera->cy = cy;
}

/// A rectified image is that of a camera without a lens, whose matrix is P, turned by R.
void read_rectified(const sensor_msgs::CameraInfo& info, Camera* camera, const std::string& topic) {
  read_focal_lengths(info.P[0], info.P[5], info.P[2], info.P[6], topic + ": P", camera);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(info.R.data());
  require_finite(Eigen::Map<const Eigen::VectorXd>(info.R.data(), 9), topic + ": R");
  if (!rotation.isUnitary(1e-3)) throw InputError(topic + ": R", "no rotation", "the rotation of the rectified image");
  camera->model_from_sensor.linear() *= rotation.transpose();
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

Camera to_camera(const sensor_msgs::CameraInfo& info, const ObservationSettings& settings,
                 const Eigen::Isometry3d& model_from_sensor, const std::string& topic) {
  require_full_image(info, topic);
  Camera camera;
  camera.projection = settings.projection == ObservationSettings::Projection::slice ? Camera::Projection::slice
                                                                                    : Camera::Projection::pinhole;
  camera.width = static_cast<int>(info.width);
  camera.height = static_cast<int>(info.height);
  camera.model_from_sensor = model_from_sensor;
  if (settings.rectified.value_or(false)) {
    read_rectified(info, &camera, topic);
    return camera;
  }
  read_focal_lengths(info.K[0], info.K[4], info.K[2], info.K[5], topic + ": K", &camera);
  set_lens(info.distortion_model, info.D, topic, &camera);
  const std::string name = settings.topic.substr(settings.topic.find_last_of('/') + 1);
  if (camera.lens != Camera::Lens::none && name.rfind("image_rect", 0) == 0 && !settings.rectified) {
    throw InputError(settings.topic, "a topic named as for rectified images, and a distortion in " + topic,
                     "`rectified: true` in the model's contour, or `rectified: false` where the lens still shows");
  }
  return camera;
}

void require_image_size(const cv::Size& image, const cv::Size& camera, const std::string& topic,
                        const std::string& camera_info) {
  const auto words = [](const cv::Size& size) { return std::to_string(size.width) + " x " + std::to_string(size.height); };
  if (image != camera) throw InputError(topic, words(image) + " pixels", words(camera) + " as in " + camera_info);
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
