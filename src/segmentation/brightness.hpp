#pragma once

#include <opencv2/core/mat.hpp>

namespace tissue_stiffness {

/// Returns whether an 8-bit image shows a dark body on a bright background. Otsu's threshold (1979) divides the grey values
/// in two parts. The part that holds three quarters or more of the image's border is the background. Returns false where
/// neither part holds that much, or where the other part is less than 0.3 % of the image.
bool shows_dark_body(const cv::Mat& image);

}  // namespace tissue_stiffness
