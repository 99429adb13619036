#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "segmentation/outline.hpp"
#include "segmentation/silhouette.hpp"

namespace tissue_stiffness {
namespace {

constexpr int band = 12, fine_band = 4;  // [pixel] reach of the searches to both sides
constexpr double wide_band = 0.3;        // of the root of the area: outward reach of the first searches
constexpr int shading_width = 4;         // [pixel] a fall that lasts longer to both sides is no edge
constexpr double clear_edge = 0.05;      // of the image's range: a fall over two pixels that counts half as a sharp edge
constexpr double sure = 0.9;             // a score that needs no second opinion

struct SharpOutline {
  Eigen::Matrix2Xd points;
  double score = 0.0;  ///< mean of s^2 / (s^2 + scale^2), s the sharpness of the fall at each point: 1 all sharp, 0 no edge
};

/// Moves `outline` along its normals, at most by `inward` and `outward` pixels, to the sharpest fall of grey value from
/// inside to outside. Falls as wide as shading are discounted. Clear edges (falls over two pixels well above `scale` grey
/// values) count alike. `stiffness` resists bends.
SharpOutline sharpest_outline(const cv::Mat& grey, const Eigen::Matrix2Xd& outline, int inward, int outward, double scale,
                              double stiffness) {
  const Eigen::Matrix2Xd normals = outward_normals(outline, 2.0);
  const Eigen::Index rows = inward + outward + 1, n = outline.cols();
  Eigen::MatrixXd sharpness(rows, n);
  Eigen::VectorXd value(rows + 2 * (shading_width + 1)), fall(rows + 2 * shading_width);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index t = 0; t < value.size(); ++t) {
      const Eigen::Vector2d p = outline.col(i) + static_cast<double>(t - inward - shading_width - 1) * normals.col(i);
      value(t) = sample_bilinear(grey, p.x(), p.y());
    }
    fall = (value.head(fall.size()) - value.tail(fall.size())).cwiseMax(0.0);
    // A fall that goes on for several pixels on either side is shading, not an edge.
    sharpness.col(i) = fall.segment(shading_width, rows) - fall.head(rows).cwiseMax(fall.tail(rows));
  }
  sharpness = sharpness.cwiseMax(0.0);
  const Eigen::ArrayXXd squared = sharpness.array().square();
  const Eigen::MatrixXd cost = -(squared / (squared + scale * scale)).matrix();
  const Eigen::VectorXi path = closed_minimum_path(cost, stiffness, 3);
  SharpOutline moved{outline, 0.0};
  for (Eigen::Index i = 0; i < n; ++i) {
    moved.points.col(i) += (path(i) - inward) * normals.col(i);
    moved.score -= cost(path(i), i) / static_cast<double>(n);
  }
  return moved;
}

/// Returns the ellipse with the area and the second moments of the enclosed region. It is smooth where shading cuts a piece
/// off a body.
Eigen::Matrix2Xd moment_ellipse(const Eigen::Matrix2Xd& outline) {
  std::vector<cv::Point2f> border;
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    border.emplace_back(static_cast<float>(outline(0, i)), static_cast<float>(outline(1, i)));
  }
  const cv::Moments m = cv::moments(border);
  const Eigen::Vector2d centre(m.m10 / m.m00, m.m01 / m.m00);
  Eigen::Matrix2d second;
  second << m.mu20, m.mu11, m.mu11, m.mu02;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(second / m.m00);
  const Eigen::Matrix2d shape = 2.0 * axes.operatorSqrt();
  Eigen::Matrix2Xd points(2, 256);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double angle = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(points.cols());
    const Eigen::Vector2d circle(std::cos(angle), std::sin(angle));
    points.col(i) = centre + shape * circle;
  }
  return points;
}

/// Searches a wide band around `start`, and then narrower ones around the result.
SharpOutline settle(const cv::Mat& smooth, const Eigen::Matrix2Xd& start, double scale, double spacing) {
  Eigen::Matrix2Xd outline = resample(smooth_closed(resample(start, spacing), 2.0), spacing);
  const int wide = std::max(band, static_cast<int>(wide_band * std::sqrt(std::abs(signed_area(outline)))));
  for (const int outward : {wide, wide, band}) {
    outline = resample(sharpest_outline(smooth, outline, band, outward, scale, 0.03).points, spacing);
    outline = resample(smooth_closed(outline, 2.0), spacing);
  }
  SharpOutline result = sharpest_outline(smooth, outline, fine_band, fine_band, scale, 0.1);
  result.points = resample(result.points, spacing);
  return result;
}

}  // namespace

Eigen::Matrix2Xd find_outline(const cv::Mat& grey, const Eigen::Matrix2Xd& region, const Eigen::Matrix2Xd& previous,
                              double spacing) {
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {}, 1.2);
  double darkest = 0.0, brightest = 0.0;
  cv::minMaxLoc(smooth, &darkest, &brightest);
  const double scale = std::max(clear_edge * (brightest - darkest), 1.0);
  SharpOutline best = settle(smooth, region, scale, spacing);
  for (const Eigen::Matrix2Xd& start : {moment_ellipse(region), previous}) {
    if (best.score > sure || start.cols() == 0) break;
    const SharpOutline other = settle(smooth, start, scale, spacing);
    if (other.score > best.score) best = other;
  }
  return best.points;
}

}  // namespace tissue_stiffness
