#include "segmentation/body_contrast.hpp"

#include <limits>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "segmentation/outline.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLeastChroma = 10.0;  // [CIE Lab] a colour nearer to grey is no colour to search for
constexpr double kMiddle = 128.0;      // of a* and b* in 8 bits
constexpr double kEdgeError = 0.25;    // [pixel] drawn bodies before grey backgrounds are 0.15 to 0.24 too large

}  // namespace

BodyContrast::BodyContrast(const SegmentationSettings& settings) : body_(settings.body), tolerance_(settings.tolerance) {
  if (body_ != SegmentationSettings::Body::colour) return;
  const Eigen::Vector3f rgb = (settings.colour / 255.0).cast<float>();
  cv::Mat lab;
  cv::cvtColor(cv::Mat(1, 1, CV_32FC3, cv::Scalar(rgb.z(), rgb.y(), rgb.x())), lab, cv::COLOR_BGR2Lab);
  const auto value = lab.at<cv::Vec3f>(0, 0);
  hue_ = Eigen::Vector2d(value[1], value[2]);
  if (hue_.norm() >= kLeastChroma) return;
  std::ostringstream found;
  found << "[" << settings.colour.transpose() << "], whose chroma in CIE Lab is " << hue_.norm();
  throw InputError("segmentation.colour", found.str(),
                   "a chroma of 10 or more; `body: bright` or `body: dark` finds a grey body");
}

cv::Mat BodyContrast::operator()(const cv::Mat& image) const {
  const cv::Mat grey = to_grey(image);
  if (body_ == SegmentationSettings::Body::bright) return grey;
  if (body_ == SegmentationSettings::Body::dark) return 255.0 - grey;
  if (image.channels() != 3) throw InputError("image", "a grey image", "a colour image for `body: colour`");
  cv::Mat lab, distance;
  cv::cvtColor(image, lab, cv::COLOR_BGR2Lab);
  cv::Mat channels[3];
  cv::split(lab, channels);
  cv::Mat a, b;
  channels[1].convertTo(a, CV_32F, 1.0, -kMiddle - hue_.x());
  channels[2].convertTo(b, CV_32F, 1.0, -kMiddle - hue_.y());
  cv::magnitude(a, b, distance);
  return -distance;
}

double BodyContrast::least() const {
  return body_ == SegmentationSettings::Body::colour ? -tolerance_ : -std::numeric_limits<double>::infinity();
}

double BodyContrast::edge_error() const {
  return body_ == SegmentationSettings::Body::colour ? kEdgeError : 0.0;
}

}  // namespace tissue_stiffness
