#include "tissue_stiffness/segmentation/silhouette.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "tissue_stiffness/segmentation/outline.hpp"

namespace tissue_stiffness {
namespace {

constexpr double spacing = 2.5;            // [pixel] between contour points
constexpr int band = 12, fine_band = 4;    // [pixel] reach of the two searches for the outline
constexpr int reach = 8;                   // [pixel] half length of the fitted profiles
constexpr double search = 3.5;             // [pixel] largest offset that a fit may find
constexpr double largest_sigma = 0.6;      // [pixel] an edge known no better than this is no edge
constexpr double smallest_fraction = 0.5;  // of the outline that must be edge
constexpr double sigma_floor = 0.05;       // [pixel] a camera's blur is not exactly Gaussian
constexpr Eigen::Index neighbours = 4;     // on each side, whose scatter counts
constexpr int shortest_run = 6;            // of points with an edge
constexpr double clear_edge = 0.05;        // of the image's range: a fall over two pixels that counts half as a sharp edge
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Edges {
  const StepEdge* model = nullptr;
  std::vector<EdgeFit> fits;
  double noise = 0.0;  ///< median standard deviation of the profiles about their fits
};

/// Fits every profile with every blur; the blur with the least median residual is the frame's.
Edges fit_edges(const std::vector<StepEdge>& models, const cv::Mat& grey, const Eigen::Matrix2Xd& outline,
                const Eigen::Matrix2Xd& normals) {
  std::vector<Eigen::VectorXd> profiles;
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    profiles.push_back(normal_profile(grey, outline.col(i), normals.col(i), reach));
  }
  Edges best;
  double least = infinity;
  for (const StepEdge& model : models) {
    Edges edges{&model, {}, 0.0};
    std::vector<double> residuals;
    for (const Eigen::VectorXd& profile : profiles) {
      edges.fits.push_back(model.fit(profile));
      residuals.push_back(edges.fits.back().residual);
    }
    const double middle = median(residuals);
    edges.noise = std::sqrt(middle / model.degrees_of_freedom());
    if (middle < least) least = middle, best = std::move(edges);
  }
  return best;
}

struct Located {
  Eigen::VectorXd offsets, sigma;
};

Located locate(const Edges& edges, const cv::Mat& grey, const Eigen::Matrix2Xd& outline) {
  const Eigen::Index n = outline.cols();
  Located result{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Constant(n, infinity)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const EdgeFit& fit = edges.fits[static_cast<std::size_t>(i)];
    if (fit.at_end || fit.gain <= 0.0 || !inside_image(outline.col(i), grey, edges.model->blur() + 1.0)) continue;
    const double noise = std::max(edges.noise, std::sqrt(fit.residual / edges.model->degrees_of_freedom()));
    const double sigma = std::max(noise, 0.1) / std::sqrt(fit.gain);
    if (sigma > largest_sigma) continue;
    result.offsets(i) = fit.offset;
    result.sigma(i) = sigma;
  }
  return result;
}

/// Rejects offsets that stand out from their neighbours' median, then raises every sigma to the scatter about it, which
/// knows of the texture that a single profile cannot see.
void compare_neighbours(Located* located) {
  const Eigen::Index n = located->sigma.size();
  Eigen::VectorXd checked = located->sigma;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!std::isfinite(located->sigma(i))) continue;
    std::vector<double> around, distances;
    for (Eigen::Index k = n - neighbours; k <= n + neighbours; ++k) {
      if (std::isfinite(located->sigma((i + k) % n))) around.push_back(located->offsets((i + k) % n));
    }
    const double middle = median(around);
    for (const double offset : around) distances.push_back(std::abs(offset - middle));
    const double spread = 1.4826 * median(distances);
    const double sigma = std::max(located->sigma(i), spread);
    const bool stands_out = std::abs(located->offsets(i) - middle) > 0.3 + 3.0 * sigma;
    checked(i) = stands_out || sigma > largest_sigma ? infinity : std::hypot(sigma, sigma_floor);
  }
  located->sigma = checked;
}

/// The ellipse with the area and the second moments of the enclosed region: smooth where shading cuts a piece off a body.
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
  Eigen::Matrix2Xd points(2, 256);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double angle = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(points.cols());
    const Eigen::Vector2d circle(std::cos(angle), std::sin(angle));
    points.col(i) = centre + 2.0 * axes.operatorSqrt() * circle;
  }
  return points;
}

/// Searches a wide band around `start`, then narrower ones around what was found.
SharpOutline settle(const cv::Mat& smooth, const Eigen::Matrix2Xd& start, double scale) {
  Eigen::Matrix2Xd outline = resample(smooth_closed(resample(start, spacing), 2.0), spacing);
  const int wide = std::max(band, static_cast<int>(0.3 * std::sqrt(std::abs(signed_area(outline)))));
  for (const int outward : {wide, wide, band}) {
    outline = resample(sharpest_outline(smooth, outline, band, outward, scale, 0.03).points, spacing);
    outline = resample(smooth_closed(outline, 2.0), spacing);
  }
  SharpOutline result = sharpest_outline(smooth, outline, fine_band, fine_band, scale, 0.1);
  result.points = resample(result.points, spacing);
  return result;
}

}  // namespace

SilhouetteSegmenter::SilhouetteSegmenter(const SegmentationSettings& settings) : seed_(settings.seed), previous_(2, 0) {
  for (const double blur : {0.5, 0.7, 1.0, 1.4, 2.0, 2.8}) edges_.emplace_back(blur, reach, search);
}

Segmentation SilhouetteSegmenter::segment(const cv::Mat& image, double stamp) {
  const cv::Mat grey = to_grey(image);
  Eigen::Matrix2Xd outline = sharpest_region(grey, seed_, previous_);
  if (outline.cols() < 8) return {{}, "no bright region of the expected size"};
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {}, 1.2);
  double darkest = 0.0, brightest = 0.0;
  cv::minMaxLoc(smooth, &darkest, &brightest);
  const double scale = std::max(clear_edge * (brightest - darkest), 1.0);
  SharpOutline best = settle(smooth, outline, scale);
  const std::vector<Eigen::Matrix2Xd> others = {moment_ellipse(outline), previous_};
  for (const Eigen::Matrix2Xd& start : others) {
    if (start.cols() < 8) continue;
    const SharpOutline other = settle(smooth, start, scale);
    if (other.score > best.score) best = other;
  }
  outline = best.points;

  Located located;
  const StepEdge* model = nullptr;
  Eigen::Matrix2Xd normals;
  for (int pass = 0; pass < 2; ++pass) {
    outline = resample(outline, spacing);
    normals = outward_normals(outline, 1.5);
    const Edges edges = fit_edges(edges_, grey, outline, normals);
    model = edges.model;
    located = locate(edges, grey, outline);
    compare_neighbours(&located);
    drop_short_runs(shortest_run, &located.sigma);
    outline = bridge_gaps(outline + normals * located.offsets.asDiagonal(), located.sigma);
  }
  const double found = static_cast<double>(located.sigma.array().isFinite().count()) / static_cast<double>(outline.cols());
  if (found < smallest_fraction) return {{}, "no closed edge around the brightest region"};
  previous_ = outline;

  Segmentation result;
  result.contour = {stamp, image.cols, image.rows, true, outline, outward_normals(outline, 1.5), {}};
  const Eigen::ArrayXd rounding = 0.5 * model->blur() * model->blur() * curvature(outline, 1.0).array().abs();
  result.contour.sigma = (located.sigma.array().square() + rounding.square()).sqrt();
  return result;
}

}  // namespace tissue_stiffness
