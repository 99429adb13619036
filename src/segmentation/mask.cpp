#include "segmentation/mask.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>
#include <vector>

#include "segmentation/outline.hpp"
#include "segmentation/region_of_interest.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/median.hpp"

namespace tissue_stiffness {
namespace {

constexpr double spacing = 2.5;             // [pixel] between contour points
constexpr double blur = 1.0;                // [pixel] of the mask before its edge is located
constexpr double reach = 4.0, step = 0.25;  // [pixel] of the search along the normal
constexpr double smoothing = 2.0;           // points
constexpr double rounding = 0.29;           // [pixel] 1 sigma of an edge rounded to whole pixels
constexpr double border = 2.0;              // [pixel] nearer to the image's border no edge is seen
constexpr double smallest_fraction = 0.5;   // of the outline that must be seen
constexpr int smallest_area = 100;          // [pixel] a smaller part is no body
constexpr double alike = 0.5;               // share of the largest part's area that makes another one a rival
constexpr Eigen::Index neighbours = 6;      // on each side, whose scatter counts
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The connected parts of a mask.
struct Parts {
  cv::Mat labels;  ///< CV_32S, 0 is the background
  std::vector<int> areas;
};

Parts parts_of(const cv::Mat& mask) {
  Parts parts;
  cv::Mat statistics, centres;
  const int count = cv::connectedComponentsWithStats(mask, parts.labels, statistics, centres, 8, CV_32S);
  for (int k = 0; k < count; ++k) parts.areas.push_back(statistics.at<int>(k, cv::CC_STAT_AREA));
  return parts;
}

std::vector<int> parts_in(const Parts& parts, const cv::Rect& rectangle) {
  std::set<int> found;
  for (int v = rectangle.y; v < rectangle.br().y; ++v) {
    const int* row = parts.labels.ptr<int>(v);
    found.insert(row + rectangle.x, row + rectangle.br().x);
  }
  found.erase(0);
  return {found.begin(), found.end()};
}

std::string in_pixels(int area) {
  return std::to_string(area) + " pixels";
}

/// Returns the number of the part that is the body, or 0 and why there is none.
int find_body(const Parts& parts, const SegmentationSettings& settings, std::string& reason) {
  const cv::Rect whole({}, parts.labels.size());
  cv::Rect searched = settings.roi ? rectangle_in(parts.labels, *settings.roi) : whole;
  if (settings.seed) {
    const cv::Point place(cvRound(settings.seed->x()), cvRound(settings.seed->y()));
    if (!whole.contains(place)) {
      throw InputError("segmentation.seed", "[" + std::to_string(place.x) + ", " + std::to_string(place.y) + "]",
                       "a pixel of the image of " + std::to_string(whole.width) + " x " + std::to_string(whole.height));
    }
    searched = cv::Rect(place, cv::Size(1, 1));
  }
  std::vector<int> found = parts_in(parts, searched);
  const auto area = [&](int part) { return parts.areas[static_cast<std::size_t>(part)]; };
  std::sort(found.begin(), found.end(), [&](int a, int b) { return area(a) > area(b); });
  if (found.empty()) {
    reason = settings.seed            ? "the mask is 0 at the seed"
             : parts.areas.size() < 2 ? "the mask is 0 everywhere"
                                      : "the mask is 0 in the region of interest";
    return 0;
  }
  if (area(found[0]) < smallest_area) {
    reason = "the mask's largest part has " + in_pixels(area(found[0]));
    return 0;
  }
  if (found.size() > 1 && area(found[1]) > alike * area(found[0])) {
    reason = "the mask has two parts of similar size, " + in_pixels(area(found[0])) + " and " + in_pixels(area(found[1])) +
             "; a seed or a roi tells which is the body";
    return 0;
  }
  return found[0];
}

/// Returns the offset along `normal` at which `soft` falls below a half, the one nearest to 0, or NaN.
double fall_along(const cv::Mat& soft, const Eigen::Vector2d& point, const Eigen::Vector2d& normal) {
  const auto at = [&](double t) {
    const Eigen::Vector2d p = point + t * normal;
    return static_cast<double>(sample_bilinear(soft, p.x(), p.y())) - 0.5;
  };
  double best = std::numeric_limits<double>::quiet_NaN();
  double before = at(-reach);
  for (double t = -reach + step; t <= reach; t += step) {
    const double value = at(t);
    const double crossing = t - step * value / (value - before);
    if (before > 0.0 && value <= 0.0 && !(std::abs(crossing) >= std::abs(best))) best = crossing;
    before = value;
  }
  return best;
}

/// Returns the root mean square of each value and its neighbours on the closed outline, of the finite ones. It is at least
/// the scatter of the whole outline, because steps that run along a stretch do not show there.
Eigen::VectorXd local_scatter(const Eigen::VectorXd& values) {
  const Eigen::Index n = values.size();
  Eigen::VectorXd result(n);
  std::vector<double> sizes;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (std::isfinite(values(i))) sizes.push_back(std::abs(values(i)));
  }
  const double least = 1.4826 * median_of(sizes);
  for (Eigen::Index i = 0; i < n; ++i) {
    double sum = 0.0, count = 0.0;
    for (Eigen::Index k = n - neighbours; k <= n + neighbours; ++k) {
      const double value = values((i + k) % n);
      if (std::isfinite(value)) sum += value * value, count += 1.0;
    }
    result(i) = count > 0.0 ? std::max(least, std::sqrt(sum / count)) : infinity;
  }
  return result;
}

}  // namespace

Segmentation MaskSegmenter::segment(const cv::Mat& image, double stamp) {
  if (image.empty() || image.type() != CV_8UC1) {
    throw InputError("mask", image.empty() ? "an empty image" : std::to_string(image.channels()) + " channels",
                     "8-bit images with 1 channel");
  }
  if (std::min(image.cols, image.rows) < smallest_image) return {{}, "the image is smaller than 32 x 32 pixels"};
  const Parts parts = parts_of(image);
  std::string reason;
  const int body = find_body(parts, settings_, reason);
  if (body == 0) return {{}, reason};

  std::vector<std::vector<cv::Point>> borders;
  cv::findContours(parts.labels == body, borders, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::Mat filled = cv::Mat::zeros(image.size(), CV_32F), soft;
  cv::drawContours(filled, borders, 0, cv::Scalar(1.0), cv::FILLED);
  cv::GaussianBlur(filled, soft, {}, blur, 0.0, cv::BORDER_REPLICATE);

  const Eigen::Matrix2Xd rough = smooth_closed(resample(to_matrix(borders.front()), spacing), smoothing);
  const Eigen::Matrix2Xd directions = outward_normals(rough, smoothing);
  Eigen::Matrix2Xd located = rough;
  Eigen::VectorXd sigma = Eigen::VectorXd::Zero(rough.cols());
  for (Eigen::Index i = 0; i < rough.cols(); ++i) {
    const double offset = fall_along(soft, rough.col(i), directions.col(i));
    if (std::isfinite(offset)) located.col(i) += offset * directions.col(i);
    if (!std::isfinite(offset) || !inside_image(located.col(i), image, border)) sigma(i) = infinity;
  }
  const Eigen::Matrix2Xd outline = smooth_keeping_bends(located, smoothing);
  const Eigen::Matrix2Xd normals = outward_normals(outline, smoothing);
  const Eigen::VectorXd apart = (located - outline).cwiseProduct(normals).colwise().sum().transpose();
  const Eigen::VectorXd scatter = local_scatter((sigma.array().isFinite()).select(apart, sigma));
  for (Eigen::Index i = 0; i < sigma.size(); ++i)
    sigma(i) = std::isfinite(sigma(i)) ? std::hypot(rounding, scatter(i)) : infinity;
  const double seen = static_cast<double>(sigma.array().isFinite().count()) / static_cast<double>(sigma.size());
  if (seen < smallest_fraction) return {{}, "most of the mask's outline is the image's border"};
  return {{stamp, image.cols, image.rows, true, outline, normals, sigma}, ""};
}

}  // namespace tissue_stiffness
