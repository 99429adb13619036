#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "check/setup_finding.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// Finds images of a silhouette whose body is darker than its background, where the model says brighter, or the other way
/// round, in more than half of them (see shows_dark_body).
SetupFindings check_images(const ObservationSettings& observation, const std::vector<cv::Mat>& images);

}  // namespace tissue_stiffness
