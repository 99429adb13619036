#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// A quantity with its band over the time of one run, as a strip chart shows it. Knows nothing of Qt or ROS.
class LiveCurve {
 public:
  struct Point {
    double time = 0.0;  ///< [s]
    double value = 0.0;
    double lower = 0.0, upper = 0.0;  ///< of the band; the value itself where there is none
  };
  /// Something that happened, to be marked.
  struct Event {
    double time = 0.0;
    std::string text;
  };
  struct Range {
    double low = 0.0, high = 1.0;
  };

  /// `capacity`: points kept, at least 4. A full curve keeps the whole run at half the resolution.
  explicit LiveCurve(std::size_t capacity = 2000) : capacity_(capacity) {}

  /// Two points at one time make a step. A time before the last one begins another run, and the curve anew; a value that
  /// is not finite is left out.
  void add(const Point& point);
  /// Marks the last point.
  void mark(const std::string& text);
  void clear();

  const std::vector<Point>& points() const { return points_; }
  const std::vector<Event>& events() const { return events_; }
  /// From the run's first point to its last, never empty.
  Range times() const;
  /// Holds every value, and the band as far as it does not flatten the curve; never empty.
  Range values() const;

 private:
  std::size_t capacity_;
  std::size_t stride_ = 1, skipped_ = 0;  ///< every stride_-th point is kept
  std::vector<Point> points_;             ///< the last one is always there, kept or not
  bool last_is_kept_ = true;
  std::vector<Event> events_;
};

/// Values inside the range at steps of 1, 2 or 5 times a power of ten, at most `most`.
std::vector<double> ticks(const LiveCurve::Range& range, int most);

}  // namespace tissue_stiffness
