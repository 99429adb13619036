#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "tissue_stiffness/types/contour.hpp"

namespace tissue_stiffness {

/// Returns the image in colour (CV_8UC3, BGR) with both outlines. The measured outline is green, and dimmed where its sigma
/// is infinite; the model's outline is magenta. `predicted`: 2 x n points [pixel] of a closed curve, which are drawn as
/// dots when a neighbour is far or not finite. `measured` and `predicted` may be empty. Throws InputError unless the image
/// is CV_8UC1 or CV_8UC3.
cv::Mat draw_overlay(const cv::Mat& image, const Contour& measured, const Eigen::Matrix2Xd& predicted);

}  // namespace tissue_stiffness
