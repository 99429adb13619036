#pragma once

#include <opencv2/core/mat.hpp>

namespace tissue_stiffness {

/// Whether an 8-bit image shows a dark body on a bright background. Otsu's threshold (1979) divides the grey values in two;
/// the background is the part that three quarters or more of the image's border belong to. False where neither part has
/// that much, or where the other one has less than 0.3 % of the image.
bool shows_dark_body(const cv::Mat& image);

}  // namespace tissue_stiffness
