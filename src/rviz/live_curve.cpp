#include "rviz/live_curve.hpp"

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kBandShare = 0.6;  // of the values' span, that a band may add on either side

}  // namespace

void LiveCurve::add(const Point& point) {
  if (!std::isfinite(point.time) || !std::isfinite(point.value)) return;
  if (!points_.empty() && point.time < points_.back().time) clear();
  if (!last_is_kept_) points_.pop_back();
  points_.push_back(point);
  last_is_kept_ = ++skipped_ >= stride_;
  if (!last_is_kept_) return;
  skipped_ = 0;
  if (points_.size() < capacity_) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); i += 2) points_[kept++] = points_[i];
  if (points_.size() % 2 == 0) points_[kept++] = points_.back();
  points_.resize(kept);
  stride_ *= 2;
}

void LiveCurve::mark(const std::string& text) {
  if (!points_.empty()) events_.push_back({points_.back().time, text});
}

void LiveCurve::clear() {
  points_.clear();
  events_.clear();
  stride_ = 1;
  skipped_ = 0;
  last_is_kept_ = true;
}

LiveCurve::Range LiveCurve::times() const {
  if (points_.empty()) return {};
  const double first = points_.front().time;
  return {first, std::max(points_.back().time, first + 1e-3)};
}

LiveCurve::Range LiveCurve::values() const {
  if (points_.empty()) return {};
  Range range{points_.front().value, points_.front().value};
  for (const Point& point : points_) {
    range.low = std::min(range.low, point.value);
    range.high = std::max(range.high, point.value);
  }
  const double scale = std::max(std::abs(range.low), std::abs(range.high));
  const double room = kBandShare * std::max(range.high - range.low, 0.05 * scale);
  Range out = range;
  for (const Point& point : points_) {
    if (std::isfinite(point.lower)) out.low = std::min(out.low, std::max(point.lower, range.low - room));
    if (std::isfinite(point.upper)) out.high = std::max(out.high, std::min(point.upper, range.high + room));
  }
  const double least = std::max(0.02 * scale, 1e-12);
  if (out.high - out.low < least) {
    out.low -= 0.5 * least;
    out.high += 0.5 * least;
  }
  return out;
}

}  // namespace tissue_stiffness
