#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace tissue_stiffness {

// Closed curves as 2 x n matrices of pixel coordinates; the last point joins the first.

/// CV_8UC1, CV_8UC3 (BGR) -> grey CV_32FC1. Throws InputError on another type or an empty image.
cv::Mat to_grey(const cv::Mat& image);

constexpr int smallest_image = 32;  ///< [pixel] width and height below which no outline is looked for

/// Bilinear value of a CV_32FC1 image of at least 2 x 2 pixels; coordinates beyond the border take the border's value.
float sample(const cv::Mat& grey, double u, double v);

/// Twice-signed-area / 2 (shoelace) [pixel^2]; positive when the curve turns from u to v.
double signed_area(const Eigen::Matrix2Xd& points);

double perimeter(const Eigen::Matrix2Xd& points);

/// The same curve with points evenly spaced in arc length, as close to `spacing` [pixel] as closure allows.
Eigen::Matrix2Xd resample(const Eigen::Matrix2Xd& points, double spacing);

/// Gaussian smoothing along a closed sequence; `sigma` in points. Works on each row.
Eigen::MatrixXd smooth_closed(const Eigen::MatrixXd& rows, double sigma);

/// The same with what the smoothing took off smoothed and put back: repeated, it does not shrink a curve's bends frame by
/// frame.
Eigen::MatrixXd smooth_keeping_bends(const Eigen::MatrixXd& rows, double sigma);

/// Unit normals that point out of the enclosed area, from tangents smoothed over `sigma` points.
Eigen::Matrix2Xd outward_normals(const Eigen::Matrix2Xd& points, double sigma);

/// Centre of the enclosed area.
Eigen::Vector2d centroid(const Eigen::Matrix2Xd& points);

/// The upper median; 0 without values.
double median(std::vector<double> values);

/// Signed curvature [1/pixel], positive where the enclosed area is convex; smoothed over `sigma` points.
Eigen::VectorXd curvature(const Eigen::Matrix2Xd& points, double sigma);

/// Row of each column on the closed path of least cost: sum of cost(row_i, i) + stiffness (row_i - row_{i-1})^2 with
/// |row_i - row_{i-1}| <= max_jump, the last column joining the first (dynamic programming; Amini et al., 1990).
Eigen::VectorXi closed_minimum_path(const Eigen::MatrixXd& cost, double stiffness, int max_jump);

/// Sets sigma to infinity in runs of fewer than `shortest` finite values: no neighbours bear them out.
void drop_short_runs(int shortest, Eigen::VectorXd* sigma);

/// Puts points of infinite sigma on the straight line between the nearest points of finite sigma on both sides.
Eigen::Matrix2Xd bridge_gaps(const Eigen::Matrix2Xd& points, const Eigen::VectorXd& sigma);

/// Whether the point lies in the image, at least `margin` [pixel] from its border.
bool inside_image(const Eigen::Vector2d& point, const cv::Mat& image, double margin);

}  // namespace tissue_stiffness
