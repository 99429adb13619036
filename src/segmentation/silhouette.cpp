#include "segmentation/silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "segmentation/outline.hpp"
#include "types/median.hpp"

namespace tissue_stiffness {
namespace {

constexpr double spacing = 2.5;            // [pixel] between contour points
constexpr int reach = 8;                   // [pixel] half length of the fitted profiles
constexpr double search = 3.5;             // [pixel] largest offset that a fit may find
constexpr double largest_sigma = 0.6;      // [pixel] an edge known no better than this is no edge
constexpr double smallest_fraction = 0.5;  // of the outline that must be edge
constexpr double smallest_share = 0.7;     // of the enclosed region that must have the body's colour
constexpr double sigma_floor = 0.05;       // [pixel] a camera's blur is not exactly Gaussian
constexpr Eigen::Index neighbours = 4;     // on each side, whose scatter counts
constexpr int shortest_run = 9;            // of points with an edge
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Edges {
  const StepEdge* model = nullptr;
  std::vector<EdgeFit> fits;
  double noise = 0.0;  ///< median standard deviation of the profiles about their fits
};

/// Fits every profile with every blur. The blur with the least median residual is taken for the whole frame.
Edges fit_edges(const std::vector<StepEdge>& models, const cv::Mat& grey, const Eigen::Matrix2Xd& outline,
                const Eigen::Matrix2Xd& normals) {
  Eigen::MatrixXd profiles(2 * reach + 1, outline.cols());
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    profiles.col(i) = normal_profile(grey, outline.col(i), normals.col(i), reach);
  }
  Edges best;
  double least = infinity;
  for (const StepEdge& model : models) {
    Edges edges{&model, model.fit(profiles), 0.0};
    std::vector<double> residuals;
    for (const EdgeFit& fit : edges.fits) residuals.push_back(fit.residual);
    const double middle = median_of(residuals);
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

/// Rejects offsets that deviate from their neighbours' median. Then it raises every sigma to the scatter about this median,
/// which includes texture that a single profile cannot show.
void compare_neighbours(Located* located) {
  const Eigen::Index n = located->sigma.size();
  Eigen::VectorXd checked = located->sigma;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!std::isfinite(located->sigma(i))) continue;
    std::vector<double> around, distances;
    for (Eigen::Index k = n - neighbours; k <= n + neighbours; ++k) {
      if (std::isfinite(located->sigma((i + k) % n))) around.push_back(located->offsets((i + k) % n));
    }
    const double middle = median_of(around);
    for (const double offset : around) distances.push_back(std::abs(offset - middle));
    const double spread = 1.4826 * median_of(distances);
    const double sigma = std::max(located->sigma(i), spread);
    const bool stands_out = std::abs(located->offsets(i) - middle) > 0.3 + 3.0 * sigma;
    checked(i) = stands_out || sigma > largest_sigma ? infinity : std::hypot(sigma, sigma_floor);
  }
  located->sigma = checked;
}

/// Returns the share of the enclosed pixels that are above `least`.
double share_above(const cv::Mat& grey, const Eigen::Matrix2Xd& outline, double least) {
  if (!std::isfinite(least)) return 1.0;
  std::vector<cv::Point> corners;
  for (Eigen::Index i = 0; i < outline.cols(); ++i) corners.emplace_back(cvRound(outline(0, i)), cvRound(outline(1, i)));
  cv::Mat inside = cv::Mat::zeros(grey.size(), CV_8U);
  cv::fillPoly(inside, std::vector<std::vector<cv::Point>>{corners}, 255);
  return cv::countNonZero(inside & (grey > least)) / std::max(1.0, static_cast<double>(cv::countNonZero(inside)));
}

}  // namespace

SilhouetteSegmenter::SilhouetteSegmenter(const SegmentationSettings& settings)
    : seed_(settings.seed), contrast_(settings), previous_(2, 0) {
  for (const double blur : {0.5, 0.7, 1.0, 1.4, 2.0, 2.8}) edges_.emplace_back(blur, reach, search);
}

Segmentation SilhouetteSegmenter::segment(const cv::Mat& image, double stamp) {
  const cv::Mat grey = contrast_(image);
  if (std::min(grey.cols, grey.rows) < smallest_image) return {{}, "the image is smaller than 32 x 32 pixels"};
  const BrightRegion region = sharpest_region(grey, seed_, previous_, contrast_.least());
  if (region.border.cols() < 8) return {{}, "no region of the expected brightness or colour and size"};
  if (region.has_rival) return {{}, "two regions are alike; a seed or a roi tells which is the body"};
  Eigen::Matrix2Xd outline = find_outline(grey, region.border, previous_, spacing);
  Eigen::VectorXd sigma;
  double blur = 0.0;
  for (int pass = 0; pass < 2; ++pass) {  // the second time along the first one's better normals
    outline = resample(outline, spacing);
    const Eigen::Matrix2Xd normals = outward_normals(outline, 1.5);
    const Edges edges = fit_edges(edges_, grey, outline, normals);
    Located located = locate(edges, grey, outline);
    compare_neighbours(&located);
    drop_short_runs(shortest_run, &located.sigma);
    outline = bridge_gaps(outline + normals * located.offsets.asDiagonal(), located.sigma);
    sigma = located.sigma;
    blur = edges.model->blur();
  }
  const double found = static_cast<double>(sigma.array().isFinite().count()) / static_cast<double>(sigma.size());
  if (found < smallest_fraction) return {{}, "no closed edge around the brightest region"};
  if (share_above(grey, outline, contrast_.least()) < smallest_share)
    return {{}, "most of the enclosed region has another colour than the body"};
  previous_ = outline;
  const Eigen::ArrayXd rounding = 0.5 * blur * blur * curvature(outline, 1.0).array().abs();
  sigma = (sigma.array().square() + rounding.square() + std::pow(contrast_.edge_error(), 2)).sqrt();
  return {{stamp, image.cols, image.rows, true, outline, outward_normals(outline, 1.5), sigma}, ""};
}

}  // namespace tissue_stiffness
