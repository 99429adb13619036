#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <string>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

// These functions convert sensor messages to the package's types. `topic` is for messages to the user: InputError names it,
// what was found in the message and what is allowed. `model_from_sensor` transforms from the message's frame to the model
// frame.

/// Returns the name of a frame without the slash that it may begin with.
std::string plain_frame(const std::string& frame);

/// Throws InputError for a stamp of zero.
void require_stamp(const std_msgs::Header& header, const std::string& topic);

/// Throws InputError for a rotation that is no unit quaternion.
Eigen::Isometry3d to_isometry(const geometry_msgs::Transform& transform, const std::string& topic);
Eigen::Isometry3d to_isometry(const geometry_msgs::Pose& pose, const std::string& topic);

/// Converts a cloud of entry `source` of the model's observations. It has fields x, y, z (FLOAT32 or FLOAT64, m), little
/// endian, and for vertices and markers an integer field `vertex` or `marker`. Points that are not finite are left out of a
/// cloud that is not dense, or of a depth camera's; in another dense cloud they are an error. `vertex_count` bounds the
/// field `vertex`.
Observation to_observation(const sensor_msgs::PointCloud2& cloud, const ObservationSettings& settings, int source,
                           int vertex_count, const Eigen::Isometry3d& model_from_sensor);

/// Reads size, focal lengths, principal point and lens (see set_lens). Binning and a region of interest are refused. For
/// rectified images the camera has P and R in place of K and D. Images whose topic is named like rectified ones are refused
/// where a lens remains and `rectified` says nothing.
Camera to_camera(const sensor_msgs::CameraInfo& info, const ObservationSettings& settings,
                 const Eigen::Isometry3d& model_from_sensor, const std::string& topic);

/// Throws InputError, naming both topics or files, for an image or film of another size than its camera's.
void require_image_size(const cv::Size& image, const cv::Size& camera, const std::string& topic,
                        const std::string& camera_info);

/// Returns the 8-bit grey or BGR pixels of an image. An image with such pixels is not copied, so the message must outlive
/// the result.
cv::Mat to_image(const sensor_msgs::ImageConstPtr& image, const std::string& topic);

/// Returns what a segmentation of this kind takes. For a mask these are 255 where the image is not 0, at any depth, so that
/// a mask of 0 and 1 in 16 bits is not lost. For the other kinds it is the image as above.
cv::Mat to_image(const sensor_msgs::ImageConstPtr& image, SegmentationSettings::Kind kind, const std::string& topic);

LoadSample to_load(const sensor_msgs::FluidPressure& pressure, const std::string& topic);

/// Converts force and torque and rotates them into the model frame.
LoadSample to_load(const geometry_msgs::WrenchStamped& wrench, const Eigen::Isometry3d& model_from_sensor,
                   const std::string& topic);

/// Converts the force on a body, measured by entry `source` of the model's observations.
Observation to_reaction(const geometry_msgs::WrenchStamped& wrench, int source, const Eigen::Isometry3d& model_from_sensor,
                        const std::string& topic);

/// Converts a pose to the model frame.
LoadSample to_load(const geometry_msgs::PoseStamped& pose, const Eigen::Isometry3d& model_from_sensor,
                   const std::string& topic);

}  // namespace tissue_stiffness
