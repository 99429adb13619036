#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// A quantity with its interval over the time of one run, for a strip chart. It does not depend on Qt or ROS.
class LiveCurve {
 public:
  struct Point {
    double time = 0.0;  ///< [s]
    double value = 0.0;
    double lower = 0.0, upper = 0.0;  ///< bounds of the interval; the value itself where there is none
  };
  /// An event that is marked on the curve.
  struct Event {
    double time = 0.0;
    std::string text;
  };
  struct Range {
    double low = 0.0, high = 1.0;
  };

  /// `capacity`: number of points that are kept, at least 4. A full curve keeps the whole run at half the resolution.
  explicit LiveCurve(std::size_t capacity = 2000) : capacity_(capacity) {}

  /// Adds a point. Two points at one time make a step. A time before the last one starts another run and a new curve. A
  /// value that is not finite is left out.
  void add(const Point& point);
  /// Marks the last point with a text.
  void mark(const std::string& text);
  void clear();

  const std::vector<Point>& points() const { return points_; }
  const std::vector<Event>& events() const { return events_; }
  /// Returns the range from the run's first point to its last; it is never empty.
  Range times() const;
  /// Returns a range that holds every value. It holds the interval as far as this does not flatten the curve. It is never
  /// empty.
  Range values() const;

 private:
  std::size_t capacity_;
  std::size_t stride_ = 1, skipped_ = 0;  ///< every stride_-th point is kept
  std::vector<Point> points_;             ///< the last point is always there, whether it is kept or not
  bool last_is_kept_ = true;
  std::vector<Event> events_;
};

}  // namespace tissue_stiffness
