#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// Turns images into grey ones in which the body is brighter than what surrounds it.
///
/// A bright body is so already, and a dark one is inverted. For a body of some colour the grey value is minus the distance
/// to this colour in the plane a*, b* of CIE Lab. Lightness does not count, so shading changes little. The distance is not
/// cut off at the tolerance, so a blurred edge remains nearly a step of the grey value.
class BodyContrast {
 public:
  /// Throws InputError for a colour without a hue.
  explicit BodyContrast(const SegmentationSettings& settings);

  /// Returns CV_32FC1. Throws InputError for an image of another type than CV_8UC1 or CV_8UC3, and for a grey one when the
  /// body is found by colour.
  cv::Mat operator()(const cv::Mat& image) const;

  /// Returns the least grey value that the body may have.
  double least() const;
  /// Returns how far the middle of a blurred edge may be off [pixel, 1 sigma], because CIE Lab is not linear.
  double edge_error() const;

 private:
  SegmentationSettings::Body body_;
  Eigen::Vector2d hue_ = Eigen::Vector2d::Zero();  ///< a*, b* of the body
  double tolerance_ = 0.0;
};

}  // namespace tissue_stiffness
