#include "segmentation/area_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "segmentation/outline.hpp"
#include "types/formatted.hpp"
#include "types/median.hpp"

namespace tissue_stiffness {
namespace {

constexpr double largest_jump = 1.3;  // factor between an area and the median of those before
constexpr double agreement = 1.1;     // factor between areas that confirm each other
constexpr std::size_t memory = 5;     // outlines
constexpr std::size_t enough = 30;    // outlines that confirm each other

double factor_between(double a, double b) {
  return std::max(a, b) / std::max(std::min(a, b), 1e-9);
}

}  // namespace

Segmentation AreaWatch::segment(const cv::Mat& image, double stamp) {
  Segmentation found = inner_->segment(image, stamp);
  if (!found.found()) return found;
  const double area = std::abs(signed_area(found.contour.points));
  const double before = median_of({believed_.begin(), believed_.end()});
  if (believed_.empty() || factor_between(area, before) < largest_jump) {
    doubted_.clear();
    believed_.push_back(area);
    if (believed_.size() > memory) believed_.pop_front();
    return found;
  }
  const auto agrees = [&](double other) { return factor_between(area, other) < agreement; };
  if (!std::all_of(doubted_.begin(), doubted_.end(), agrees)) doubted_.clear();
  doubted_.push_back(area);
  if (doubted_.size() == enough) {
    believed_ = std::exchange(doubted_, {});
    return found;
  }
  inner_->reset();
  return {{}, formatted("the outline's area jumps to %.2f times that of the frames before", area / before)};
}

void AreaWatch::reset() {
  inner_->reset();
  believed_.clear();
  doubted_.clear();
}

}  // namespace tissue_stiffness
