#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tissue_stiffness/types/contour.hpp"

namespace tissue_stiffness {

/// Fraction of each pixel that lies inside, from 8 x 8 samples a pixel.
inline cv::Mat coverage(cv::Size size, const std::function<bool(double, double)>& inside) {
  cv::Mat result = cv::Mat::zeros(size, CV_32F);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      int count = 0;
      for (int k = 0; k < 64; ++k) count += inside(u - 0.4375 + 0.125 * (k % 8), v - 0.4375 + 0.125 * (k / 8));
      result.at<float>(v, u) = static_cast<float>(count) / 64.0F;
    }
  }
  return result;
}

/// Smooth random texture of the given mean and standard deviation.
inline cv::Mat texture(cv::Size size, double mean, double deviation, double length, unsigned seed) {
  cv::RNG random(seed);
  cv::Mat image(size, CV_32F);
  random.fill(image, cv::RNG::NORMAL, 0.0, 1.0);
  cv::GaussianBlur(image, image, {}, length);
  cv::Scalar m, s;
  cv::meanStdDev(image, m, s);
  return (image - m[0]) * (deviation / s[0]) + mean;
}

/// Camera image of a body: linear mix by coverage, blur, noise, 8 bits.
inline cv::Mat camera_image(const cv::Mat& body, const cv::Mat& background, const cv::Mat& cover, double blur, double noise,
                            unsigned seed) {
  cv::Mat image = background.mul(1.0 - cover) + body.mul(cover), grain(image.size(), CV_32F), result;
  cv::GaussianBlur(image, image, {}, blur);
  cv::RNG random(seed);
  random.fill(grain, cv::RNG::NORMAL, 0.0, noise);
  image += grain;
  image.convertTo(result, CV_8U);
  return result;
}

/// B-mode image of scatterers of the given strength: Gaussian pulse, envelope, 60 dB of it in 256 grey levels. The
/// strongest mean echo, of strength 1, is at 200.
inline cv::Mat echo_image(const cv::Mat& strength, double lateral, double axial, unsigned seed) {
  cv::RNG random(seed);
  cv::Mat power = cv::Mat::zeros(strength.size(), CV_32F);
  for (int part = 0; part < 2; ++part) {
    cv::Mat field(strength.size(), CV_32F);
    random.fill(field, cv::RNG::NORMAL, 0.0, 1.0);
    field = field.mul(strength);
    cv::GaussianBlur(field, field, {}, lateral, axial);
    power += field.mul(field);
  }
  const double mean_power = 2.0 / (4.0 * M_PI * lateral * axial);
  cv::Mat decibel, result;
  cv::log(power / mean_power + 1e-8, decibel);
  decibel = decibel * (10.0 / std::log(10.0)) * (255.0 / 60.0) + 200.0;
  decibel.convertTo(result, CV_8U);
  return result;
}

/// Moments of (error, error / sigma) over the points of finite sigma.
struct Errors {
  int count = 0;
  double mean = 0.0, deviation = 0.0, worst = 0.0, nis = 0.0;
};

inline Errors errors_of(const Contour& contour, const std::function<double(const Eigen::Vector2d&)>& signed_distance) {
  Errors errors;
  double squares = 0.0;
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    if (!std::isfinite(contour.sigma(i))) continue;
    const double error = signed_distance(contour.points.col(i));
    ++errors.count;
    errors.mean += error;
    squares += error * error;
    errors.worst = std::max(errors.worst, std::abs(error));
    errors.nis += std::pow(error / contour.sigma(i), 2);
  }
  errors.mean /= std::max(errors.count, 1);
  errors.nis /= std::max(errors.count, 1);
  errors.deviation = std::sqrt(std::max(0.0, squares / std::max(errors.count, 1) - errors.mean * errors.mean));
  return errors;
}

}  // namespace tissue_stiffness
