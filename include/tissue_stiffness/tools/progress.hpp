#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>

namespace tissue_stiffness {

/// Progress of long work: a bar with rate and time left on a terminal, a plain line every 5 s elsewhere.
class Progress {
 public:
  enum class Style { bar, lines, quiet };

  Progress(std::ostream& out, Style style, std::string what);

  /// bar when standard error is a terminal, lines otherwise.
  static Style style_of_stderr(bool quiet);

  void show(std::size_t done, std::size_t total);
  /// Ends the bar's line.
  void finish();

 private:
  void draw(std::size_t done, std::size_t total, double elapsed);

  std::ostream& out_;
  Style style_;
  std::string what_;
  std::chrono::steady_clock::time_point start_;
  double last_shown_ = 0.0;
  bool drawn_ = false;
};

/// Progress of work whose steps have names: which one, and for how long by now. Where steps are counted, how many of them
/// are done and how long the others will take at that pace. One line that changes on a terminal; elsewhere a line a step,
/// and while one step goes on a line every 5 s.
class StepProgress {
 public:
  /// The seconds since some fixed time.
  using Clock = std::function<double()>;

  StepProgress(std::ostream& out, Progress::Style style, std::string what, Clock clock = steady_seconds);

  /// The time of std::chrono::steady_clock [s].
  static double steady_seconds();

  /// A step begins; `done` of `total` alike are over (0 of 0: nobody counts). A `done` of 0 begins a new count.
  void show(const std::string& step, std::size_t done = 0, std::size_t total = 0);
  /// Ends the line.
  void finish();

 private:
  std::ostream& out_;
  Progress::Style style_;
  std::string what_;
  Clock clock_;
  double start_;                ///< [s]
  double counted_since_ = 0.0;  ///< when the count began [s]
  double last_shown_ = 0.0;
  std::string last_step_;
  int steps_ = 0;
};

}  // namespace tissue_stiffness
