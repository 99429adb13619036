#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "segmentation/cavity.hpp"
#include "segmentation/outline.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t rays = 24;
constexpr int grid = 6;                                          // [pixel] between the tried centres
constexpr double smallest_radius = 0.035, largest_radius = 0.4;  // of the image's height
constexpr double darkest_tissue = 6.0;                           // [grey] the scanned sector is brighter nearly everywhere
constexpr double centrality = 0.25;  // of the sector's height: the chamber of interest is usually near the middle
constexpr double floor_grey = 8.0;   // keeps the contrast of black on black at zero

struct Ray {
  double radius = 0.0, contrast = 0.0;
};

/// Finds the place along one ray where the next pixels are brightest compared with the mean of all pixels before.
Ray clearest_wall(const cv::Mat& grey, const cv::Mat& sector, const Eigen::Vector2d& centre,
                  const Eigen::Vector2d& direction) {
  Ray best;
  double sum = sample_bilinear(grey, centre.x(), centre.y());
  int count = 1;
  const double lowest = smallest_radius * grey.rows, highest = largest_radius * grey.rows;
  for (double r = 2.0; r < highest; r += 2.0) {
    const Eigen::Vector2d p = centre + r * direction, outside = centre + (r + 4.0) * direction;
    if (!inside_image(outside, grey, 1.0)) break;
    if (sector.at<unsigned char>(cvRound(outside.y()), cvRound(outside.x())) == 0) break;
    const double before = sum / count, after = sample_bilinear(grey, outside.x(), outside.y());
    const double contrast = (after - before) / (after + before + floor_grey);
    if (r > lowest && contrast > best.contrast) best = {r, contrast};
    sum += sample_bilinear(grey, p.x(), p.y());
    ++count;
  }
  return best;
}

/// Returns the convex hull of the largest connected lit part, which is the scanned sector without labels. It is empty when
/// nothing is lit.
std::vector<cv::Point> lit_sector(const cv::Mat& grey) {
  cv::Mat lit = grey > darkest_tissue;
  cv::morphologyEx(lit, lit, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_ELLIPSE, {9, 9}));
  std::vector<std::vector<cv::Point>> parts;
  cv::findContours(lit, parts, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  std::vector<cv::Point> hull;
  const auto by_area = [](const auto& a, const auto& b) { return cv::contourArea(a) < cv::contourArea(b); };
  const auto largest = std::max_element(parts.begin(), parts.end(), by_area);
  if (largest != parts.end()) cv::convexHull(*largest, hull);
  return hull;
}

Pool pool_at(const cv::Mat& grey, const cv::Mat& sector, const Eigen::Vector2d& centre) {
  Pool pool{centre, 0.0, 0.0};
  double roughness = 0.0, mean_radius = 0.0;
  std::array<Ray, rays> met;
  for (std::size_t k = 0; k < rays; ++k) {
    const double angle = 2.0 * M_PI * static_cast<double>(k) / rays;
    met[k] = clearest_wall(grey, sector, centre, {std::cos(angle), std::sin(angle)});
  }
  for (std::size_t k = 0; k < rays; ++k) {
    pool.score += met[k].contrast / rays;
    pool.radius += met[k].radius * met[k].radius / rays;
    mean_radius += met[k].radius / rays;
    roughness += std::abs(met[k].radius - met[(k + 1) % rays].radius) / rays;
  }
  pool.radius = std::sqrt(pool.radius);
  pool.score *= 1.0 - std::min(1.0, roughness / std::max(mean_radius, 1.0));
  return pool;
}

}  // namespace

Pool find_pool(const cv::Mat& grey) {
  const std::vector<cv::Point> hull = lit_sector(grey);
  Pool best;
  if (hull.size() < 3) return best;
  cv::Mat sector = cv::Mat::zeros(grey.size(), CV_8U);
  cv::fillConvexPoly(sector, hull, 255);
  const cv::Rect box = cv::boundingRect(hull);
  const Eigen::Vector2d middle(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  double best_merit = 0.0;
  for (int v = grid; v < grey.rows - grid; v += grid) {
    for (int u = grid; u < grey.cols - grid; u += grid) {
      if (sector.at<unsigned char>(v, u) == 0) continue;
      const Pool pool = pool_at(grey, sector, {u, v});
      const double distance = (pool.centre - middle).norm() / (centrality * box.height);
      const double merit = pool.score * std::sqrt(pool.radius) * std::exp(-0.5 * distance * distance);
      if (merit > best_merit) best_merit = merit, best = pool;
    }
  }
  return best;
}

}  // namespace tissue_stiffness
