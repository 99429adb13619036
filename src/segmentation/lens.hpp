#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/contour.hpp"
#include "tissue_stiffness/types/feature_tracks.hpp"

namespace tissue_stiffness {

// A lens moves each point of the image that a pinhole would make. The models and the order of their coefficients are those
// of OpenCV and of sensor_msgs/CameraInfo. Everything behind these functions works in the undistorted image.

/// Gives the camera the lens that CameraInfo's `distortion_model` and D describe. Without coefficients, or with zeros only,
/// there is no lens. `where` is for messages. Throws InputError for an unknown model, which it names, for a wrong count and
/// for coefficients of a slice, which has no lens.
void set_lens(const std::string& model, const std::vector<double>& coefficients, const std::string& where, Camera* camera);

/// Returns CameraInfo's name of the model; plumb_bob, with zeros, where there is no lens.
std::string lens_name(Camera::Lens lens);

/// Returns where the lens puts points [pixel] of the undistorted image. NaN stays NaN.
Eigen::Matrix2Xd distort(const Camera& camera, const Eigen::Matrix2Xd& points);

/// Returns where points [pixel] of the camera's image would be without the lens, or NaN where no place is put there.
Eigen::Matrix2Xd undistort(const Camera& camera, const Eigen::Matrix2Xd& points);

/// Moves a contour of the camera's image, with its normals and sigmas, to the undistorted image. A point that has no place
/// there keeps its own with an infinite sigma.
void undistort(const Camera& camera, Contour* contour);

/// Moves features to the undistorted image. One without a place there gets NaN, and sigmas stay as they are.
void undistort(const Camera& camera, FeatureTracks* tracks);

/// Returns the undistorted image, in the same size.
cv::Mat undistort(const Camera& camera, const cv::Mat& image);

}  // namespace tissue_stiffness
