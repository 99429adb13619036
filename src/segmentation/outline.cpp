#include "segmentation/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

cv::Mat grey_bytes(const cv::Mat& image) {
  if (image.empty()) throw InputError("image", "an empty image", "8-bit images with 1 or 3 channels");
  if (image.type() != CV_8UC1 && image.type() != CV_8UC3) {
    const std::string type =
        std::to_string(8 * image.elemSize1()) + " bits x " + std::to_string(image.channels()) + " channels";
    throw InputError("image", type, "8-bit images with 1 or 3 channels");
  }
  cv::Mat grey = image;
  if (image.channels() == 3) cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

cv::Mat to_grey(const cv::Mat& image) {
  cv::Mat result;
  grey_bytes(image).convertTo(result, CV_32F);
  return result;
}

float sample_bilinear(const cv::Mat& grey, double u, double v) {
  const double x = std::clamp(u, 0.0, static_cast<double>(grey.cols - 1));
  const double y = std::clamp(v, 0.0, static_cast<double>(grey.rows - 1));
  const int x0 = std::min(static_cast<int>(x), grey.cols - 2);
  const int y0 = std::min(static_cast<int>(y), grey.rows - 2);
  const float fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const float* upper = grey.ptr<float>(y0) + x0;
  const float* lower = grey.ptr<float>(y0 + 1) + x0;
  const float top = upper[0] + fx * (upper[1] - upper[0]);
  const float bottom = lower[0] + fx * (lower[1] - lower[0]);
  return top + fy * (bottom - top);
}

double signed_area(const Eigen::Matrix2Xd& points) {
  double twice = 0.0;
  const Eigen::Index n = points.cols();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index j = (i + 1) % n;
    twice += points(0, i) * points(1, j) - points(0, j) * points(1, i);
  }
  return 0.5 * twice;
}

double perimeter(const Eigen::Matrix2Xd& points) {
  double length = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    length += (points.col((i + 1) % points.cols()) - points.col(i)).norm();
  }
  return length;
}

Eigen::Matrix2Xd resample(const Eigen::Matrix2Xd& points, double spacing) {
  const double length = perimeter(points);
  const Eigen::Index n = points.cols();
  const Eigen::Index count = std::max<Eigen::Index>(8, std::lround(length / spacing));
  Eigen::Matrix2Xd result(2, count);
  Eigen::Index segment = 0;
  double start = 0.0, segment_length = (points.col(1 % n) - points.col(0)).norm();
  for (Eigen::Index i = 0; i < count; ++i) {
    const double position = length * static_cast<double>(i) / static_cast<double>(count);
    while (position > start + segment_length && segment + 1 < n) {
      start += segment_length;
      ++segment;
      segment_length = (points.col((segment + 1) % n) - points.col(segment)).norm();
    }
    const double fraction = segment_length > 0.0 ? (position - start) / segment_length : 0.0;
    result.col(i) = (1.0 - fraction) * points.col(segment) + fraction * points.col((segment + 1) % n);
  }
  return result;
}

Eigen::MatrixXd smooth_closed(const Eigen::MatrixXd& rows, double sigma) {
  const Eigen::Index n = rows.cols();
  const Eigen::Index reach = std::min<Eigen::Index>(static_cast<Eigen::Index>(std::ceil(3.0 * sigma)), (n - 1) / 2);
  Eigen::MatrixXd result = rows;
  if (sigma <= 0.0) return result;
  double total = 1.0;
  for (Eigen::Index k = 1; k <= reach; ++k) {
    const double weight = std::exp(-0.5 * static_cast<double>(k * k) / (sigma * sigma));
    for (Eigen::Index i = 0; i < n; ++i) result.col(i) += weight * (rows.col((i + k) % n) + rows.col((i + n - k) % n));
    total += 2.0 * weight;
  }
  return result / total;
}

Eigen::MatrixXd smooth_keeping_bends(const Eigen::MatrixXd& rows, double sigma) {
  const Eigen::MatrixXd smooth = smooth_closed(rows, sigma);
  return smooth + smooth_closed(rows - smooth, sigma);
}

Eigen::Matrix2Xd outward_normals(const Eigen::Matrix2Xd& points, double sigma) {
  const Eigen::Matrix2Xd smooth = smooth_closed(points, sigma);
  const double sign = signed_area(points) >= 0.0 ? 1.0 : -1.0;
  const Eigen::Index n = points.cols();
  Eigen::Matrix2Xd normals(2, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d tangent = smooth.col((i + 1) % n) - smooth.col((i + n - 1) % n);
    normals.col(i) = sign * Eigen::Vector2d(tangent.y(), -tangent.x()).normalized();
  }
  return normals;
}

Eigen::Vector2d centroid(const Eigen::Matrix2Xd& points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  const Eigen::Index n = points.cols();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d a = points.col(i), b = points.col((i + 1) % n);
    sum += (a + b) * (a.x() * b.y() - a.y() * b.x());
  }
  return sum / (6.0 * signed_area(points));
}

Eigen::VectorXd curvature(const Eigen::Matrix2Xd& points, double sigma) {
  const Eigen::Matrix2Xd smooth = smooth_closed(points, sigma);
  const double sign = signed_area(points) >= 0.0 ? 1.0 : -1.0;
  const Eigen::Index n = points.cols();
  Eigen::VectorXd result(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d before = smooth.col(i) - smooth.col((i + n - 1) % n);
    const Eigen::Vector2d after = smooth.col((i + 1) % n) - smooth.col(i);
    const double turn = std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
    result(i) = sign * turn / std::max(0.5 * (before.norm() + after.norm()), 1e-9);
  }
  return result;
}

namespace {

/// Finds the cheapest open path, whose rows are given by back-pointers. With `first_row` >= 0 the path starts there and
/// ends at most `max_jump` rows from it.
Eigen::VectorXi minimum_path(const Eigen::MatrixXd& cost, double stiffness, int max_jump, int first_row, double* total) {
  const int rows = static_cast<int>(cost.rows()), columns = static_cast<int>(cost.cols());
  const double infinity = std::numeric_limits<double>::infinity();
  Eigen::MatrixXi from(rows, columns);
  Eigen::VectorXd best = cost.col(0), next(rows);
  if (first_row >= 0) {
    best.setConstant(infinity);
    best(first_row) = cost(first_row, 0);
  }
  for (int i = 1; i < columns; ++i) {
    for (int r = 0; r < rows; ++r) {
      next(r) = infinity;
      from(r, i) = r;
      for (int q = std::max(0, r - max_jump); q <= std::min(rows - 1, r + max_jump); ++q) {
        const double candidate = best(q) + stiffness * (r - q) * (r - q);
        if (candidate < next(r)) next(r) = candidate, from(r, i) = q;
      }
      next(r) += cost(r, i);
    }
    best.swap(next);
  }
  if (first_row >= 0) {
    for (int r = 0; r < rows; ++r) {
      best(r) += std::abs(r - first_row) <= max_jump ? stiffness * (r - first_row) * (r - first_row) : infinity;
    }
  }
  int row = 0;
  *total = best.minCoeff(&row);
  Eigen::VectorXi path(columns);
  for (int i = columns - 1; i >= 0; --i) {
    path(i) = row;
    if (i > 0) row = from(row, i);
  }
  return path;
}

}  // namespace

Eigen::VectorXi closed_minimum_path(const Eigen::MatrixXd& cost, double stiffness, int max_jump) {
  // An open path over two turns settles in the middle. A second pass is closed through the row that was found there.
  const Eigen::Index n = cost.cols(), half = n / 2;
  Eigen::MatrixXd twice(cost.rows(), 2 * n);
  twice << cost, cost;
  double total = 0.0;
  const int through = minimum_path(twice, stiffness, max_jump, -1, &total)(n);
  const Eigen::VectorXi closed = minimum_path(cost, stiffness, max_jump, through, &total);
  if (std::isfinite(total)) return closed;
  return minimum_path(twice, stiffness, max_jump, -1, &total).segment(half, n);
}

void drop_short_runs(int shortest, Eigen::VectorXd* sigma) {
  const Eigen::Index n = sigma->size();
  const Eigen::VectorXd before = *sigma;
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index a = 0, b = 0;
    while (a < shortest && std::isfinite(before((i + n - a % n) % n))) ++a;
    while (b < shortest && std::isfinite(before((i + b) % n))) ++b;
    if (a + b - 1 < shortest) (*sigma)(i) = std::numeric_limits<double>::infinity();
  }
}

Eigen::Matrix2Xd bridge_gaps(const Eigen::Matrix2Xd& points, const Eigen::VectorXd& sigma) {
  const Eigen::Index n = sigma.size();
  Eigen::Matrix2Xd result = points;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (std::isfinite(sigma(i))) continue;
    Eigen::Index a = 1, b = 1;
    while (a < n && !std::isfinite(sigma((i + n - a) % n))) ++a;
    while (b < n && !std::isfinite(sigma((i + b) % n))) ++b;
    if (a == n) return points;
    const double fraction = static_cast<double>(a) / static_cast<double>(a + b);
    result.col(i) = (1.0 - fraction) * points.col((i + n - a) % n) + fraction * points.col((i + b) % n);
  }
  return result;
}

bool inside_image(const Eigen::Vector2d& point, const cv::Mat& image, double margin) {
  return point.x() >= margin && point.y() >= margin && point.x() <= image.cols - 1 - margin &&
         point.y() <= image.rows - 1 - margin;
}

}  // namespace tissue_stiffness
