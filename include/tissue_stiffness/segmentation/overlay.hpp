#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "tissue_stiffness/types/contour.hpp"

namespace tissue_stiffness {

/// The image in colour (CV_8UC3, BGR) with the measured outline in green, dimmed where it has infinite sigma, and the
/// model's outline in magenta. `predicted`: 2 x n points [pixel] of a closed curve, drawn as dots when a neighbour is far
/// or not finite; may be empty, as may `measured`. Throws InputError unless the image is CV_8UC1 or CV_8UC3.
cv::Mat draw_overlay(const cv::Mat& image, const Contour& measured, const Eigen::Matrix2Xd& predicted);

}  // namespace tissue_stiffness
