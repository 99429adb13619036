#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace tissue_stiffness {

// Closed curves are 2 x n matrices of pixel coordinates. The last point is joined to the first.

/// Converts OpenCV's points to columns.
template <typename Point>
Eigen::Matrix2Xd to_matrix(const std::vector<Point>& points) {
  Eigen::Matrix2Xd out(2, static_cast<Eigen::Index>(points.size()));
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    const Point& p = points[static_cast<std::size_t>(i)];
    out.col(i) << static_cast<double>(p.x), static_cast<double>(p.y);
  }
  return out;
}

/// Converts CV_8UC1 or CV_8UC3 (BGR) to grey CV_8UC1; grey is not copied. Throws InputError for another type or an empty
/// image.
cv::Mat grey_bytes(const cv::Mat& image);

/// Converts CV_8UC1 or CV_8UC3 (BGR) to grey CV_32FC1. Throws InputError for another type or an empty image.
cv::Mat to_grey(const cv::Mat& image);

constexpr int smallest_image = 32;  ///< smallest width and height in which an outline is searched for [pixel]

/// Interpolates a CV_32FC1 image of at least 2 x 2 pixels bilinearly. Coordinates beyond the border take the border's
/// value.
float sample_bilinear(const cv::Mat& grey, double u, double v);

/// Returns the signed area by the shoelace formula [pixel^2]. It is positive when the curve turns from u to v.
double signed_area(const Eigen::Matrix2Xd& points);

double perimeter(const Eigen::Matrix2Xd& points);

/// Returns the curve with points evenly spaced in arc length, as close to `spacing` [pixel] as closure allows.
Eigen::Matrix2Xd resample(const Eigen::Matrix2Xd& points, double spacing);

/// Applies Gaussian smoothing along a closed sequence to each row; `sigma` is in points.
Eigen::MatrixXd smooth_closed(const Eigen::MatrixXd& rows, double sigma);

/// Smooths like smooth_closed, but adds the smoothed difference from the original again. So repeated smoothing does not
/// flatten a curve's bends from frame to frame.
Eigen::MatrixXd smooth_keeping_bends(const Eigen::MatrixXd& rows, double sigma);

/// Returns unit normals that point out of the enclosed area, from tangents smoothed over `sigma` points.
Eigen::Matrix2Xd outward_normals(const Eigen::Matrix2Xd& points, double sigma);

/// Returns the centre of the enclosed area.
Eigen::Vector2d centroid(const Eigen::Matrix2Xd& points);

/// Returns the signed curvature [1/pixel], smoothed over `sigma` points. It is positive where the enclosed area is convex.
Eigen::VectorXd curvature(const Eigen::Matrix2Xd& points, double sigma);

/// Returns the row of each column on the closed path of least cost. The cost is the sum of cost(row_i, i) + stiffness
/// (row_i - row_{i-1})^2 with |row_i - row_{i-1}| <= max_jump. The last column is joined to the first (dynamic programming;
/// Amini et al., 1990).
Eigen::VectorXi closed_minimum_path(const Eigen::MatrixXd& cost, double stiffness, int max_jump);

/// Sets sigma to infinity in runs of fewer than `shortest` finite values, because no neighbours confirm them.
void drop_short_runs(int shortest, Eigen::VectorXd* sigma);

/// Moves points of infinite sigma onto the straight line between the nearest points of finite sigma on both sides.
Eigen::Matrix2Xd bridge_gaps(const Eigen::Matrix2Xd& points, const Eigen::VectorXd& sigma);

/// Returns whether the point lies in the image, at least `margin` [pixel] from its border.
bool inside_image(const Eigen::Vector2d& point, const cv::Mat& image, double margin);

}  // namespace tissue_stiffness
