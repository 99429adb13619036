#include "segmentation/texture_window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace tissue_stiffness {
namespace {

constexpr int kSmoothing = 5;         // [pixel] edge of the Gaussian filter of both images
constexpr int kMargin = 8;            // [pixel] around a window within which it may deform
constexpr int kIterations = 20;       // of the search
constexpr double kFound = 1e-4;       // gain of the correlation at which it ends
constexpr double kAlike = 0.8;        // least correlation
constexpr double kSingular = 1e-6;    // least eigenvalue of the unknowns' correlations
constexpr double kLeastSigma = 0.02;  // [pixel] in images without noise: interpolation

void filter(cv::Mat& image) {
  cv::GaussianBlur(image, image, cv::Size(kSmoothing, kSmoothing), 0);
}

// What the filter does to the variance of white noise, and of its gradient, by the response to a single pixel.
struct FilteredNoise {
  double variance, gradient;
  FilteredNoise() {
    cv::Mat pixel = cv::Mat::zeros(4 * kSmoothing + 1, 4 * kSmoothing + 1, CV_32F), gradients;
    pixel.at<float>(2 * kSmoothing, 2 * kSmoothing) = 1.0F;
    filter(pixel);
    cv::Sobel(pixel, gradients, CV_32F, 1, 0, 3, 1.0 / 8.0);
    variance = pixel.dot(pixel);
    gradient = gradients.dot(gradients);
  }
};
const FilteredNoise& filtered_noise() {
  static const FilteredNoise out;
  return out;
}

cv::Rect around(const cv::Point& centre, int half) {
  return {centre.x - half, centre.y - half, 2 * half + 1, 2 * half + 1};
}

}  // namespace

TextureWindow::TextureWindow(const cv::Mat& smooth, const cv::Point& centre) : deformation_(cv::Matx22f::eye()) {
  const cv::Mat part = smooth(around(centre, half));  // filters see what lies around it, too
  cv::Mat right, down;
  cv::Sobel(part, right, CV_32F, 1, 0, 3, 1.0 / 8.0);
  cv::Sobel(part, down, CV_32F, 0, 1, 3, 1.0 / 8.0);
  window_ = part.clone();
  cv::Scalar mean, deviation;
  cv::meanStdDev(window_, mean, deviation);
  contrast_ = deviation[0];
  cv::Mat x(edge, edge, CV_32F), y;
  for (int u = 0; u < edge; ++u) x.col(u).setTo(u - half);
  y = x.t();
  const std::array<cv::Mat, 8> tangents{right,
                                        down,
                                        right.mul(x),
                                        right.mul(y),
                                        down.mul(x),
                                        down.mul(y),
                                        cv::Mat::ones(edge, edge, CV_32F),
                                        window_ - mean[0]};
  std::array<cv::Mat, 8> filtered;
  for (std::size_t i = 0; i < 8; ++i) {
    cv::copyMakeBorder(tangents[i], filtered[i], kSmoothing, kSmoothing, kSmoothing, kSmoothing, cv::BORDER_CONSTANT);
    filter(filtered[i]);
  }
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 8; ++k) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(k);
      information_(i, k) = tangents[a].dot(tangents[b]);
      noise_(i, k) = filtered[a].dot(filtered[b]);
    }
  }
}

double TextureWindow::sigma(double noise) const {
  constexpr double count = edge * edge;
  double second_moment = 0.0;
  for (int u = -half; u <= half; ++u) second_moment += u * u * edge;
  Matrix own = information_;
  const double gradient = filtered_noise().gradient * noise * noise;
  for (const int i : {0, 1}) own(i, i) -= gradient * count;
  for (const int i : {2, 3, 4, 5}) own(i, i) -= gradient * second_moment;
  // In units in which each unknown alone is known to 1.
  cv::Vec<double, 8> unit;
  for (int i = 0; i < 8; ++i) {
    if (!(own(i, i) > 0.0)) return std::numeric_limits<double>::infinity();
    unit[i] = 1.0 / std::sqrt(own(i, i));
  }
  const Matrix scale = Matrix::diag(unit);
  const Matrix correlations = scale * own * scale;
  cv::Mat values;
  cv::eigen(correlations, values);
  if (!(values.at<double>(7) > kSingular)) return std::numeric_limits<double>::infinity();
  const Matrix inverse = scale * correlations.inv(cv::DECOMP_CHOLESKY) * scale;
  const Matrix covariance = 2.0 * noise * noise * inverse * noise_ * inverse;
  const double mean = 0.5 * (covariance(0, 0) + covariance(1, 1)),
               apart = std::hypot(0.5 * (covariance(0, 0) - covariance(1, 1)), covariance(0, 1));
  return std::hypot(kLeastSigma, std::sqrt(mean + apart));
}

std::optional<TextureWindow::Place> TextureWindow::find(const cv::Mat& smooth, const cv::Point2f& there) {
  const cv::Rect all(0, 0, smooth.cols, smooth.rows),
      part = around(cv::Point(cvRound(there.x), cvRound(there.y)), half + kMargin) & all;
  if (part.width < edge || part.height < edge) return {};
  const cv::Point2f origin(static_cast<float>(part.x), static_cast<float>(part.y));
  const cv::Vec2f centre(half, half), turned = deformation_ * centre;
  cv::Mat warp = (cv::Mat_<float>(2, 3) << deformation_(0, 0), deformation_(0, 1), there.x - origin.x - turned[0],
                  deformation_(1, 0), deformation_(1, 1), there.y - origin.y - turned[1]);
  double correlation = 0.0;
  try {
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kIterations, kFound);
    correlation = cv::findTransformECC(window_, smooth(part), warp, cv::MOTION_AFFINE, until, cv::noArray(), 1);
  } catch (const cv::Exception&) {  // it says so where it does not converge
    return {};
  }
  const cv::Matx22f deformation(warp.at<float>(0, 0), warp.at<float>(0, 1), warp.at<float>(1, 0), warp.at<float>(1, 1));
  const cv::Vec2f moved = deformation * centre;
  const cv::Point2f now = origin + cv::Point2f(moved[0] + warp.at<float>(0, 2), moved[1] + warp.at<float>(1, 2));
  if (!(correlation > kAlike) || !(cv::norm(now - there) < kMargin) || !all.contains(now)) return {};
  // What is left has the noise of both windows. The filter leaves a part of it.
  const double left = contrast_ * std::sqrt(std::max(0.0, 1.0 - correlation * correlation));
  const double known = sigma(left / std::sqrt(2.0 * filtered_noise().variance));
  if (!std::isfinite(known)) return {};
  deformation_ = deformation;
  return Place{now, known};
}

cv::Mat smooth_image(const cv::Mat& grey) {
  cv::Mat out;
  grey.convertTo(out, CV_32F);
  filter(out);
  return out;
}

double image_noise(const cv::Mat& grey) {
  const cv::Mat kernel = (cv::Mat_<float>(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1);
  cv::Mat differences;
  cv::filter2D(grey, differences, CV_32F, kernel);
  return std::sqrt(M_PI / 2.0) * cv::norm(differences, cv::NORM_L1) / (6.0 * static_cast<double>(differences.total()));
}

}  // namespace tissue_stiffness
