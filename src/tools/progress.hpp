#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>

namespace tissue_stiffness {

/// Progress of long work. On a terminal it is a bar with rate and remaining time, elsewhere a plain line every 5 s.
class Progress {
 public:
  enum class Style { bar, lines, quiet };

  Progress(std::ostream& out, Style style, std::string what);

  /// Returns `bar` when standard error is a terminal, and `lines` otherwise.
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

/// Progress of work in named steps: the current step and the elapsed time. If a step is counted, it also shows how many
/// parts are done and estimates the remaining time. On a terminal one line is updated. Elsewhere there is one line for each
/// step, and one every 5 s during a step.
class StepProgress {
 public:
  /// Returns the seconds since some fixed time.
  using Clock = std::function<double()>;

  StepProgress(std::ostream& out, Progress::Style style, std::string what, Clock clock = steady_seconds);

  /// Returns the time of std::chrono::steady_clock [s].
  static double steady_seconds();

  /// Shows a step; `done` of `total` equal parts are finished (0 of 0: they are not counted). A `done` of 0 starts a new
  /// count.
  void show(const std::string& step, std::size_t done = 0, std::size_t total = 0);
  /// Ends the line.
  void finish();

 private:
  std::ostream& out_;
  Progress::Style style_;
  std::string what_;
  Clock clock_;
  double start_;                ///< [s]
  double counted_since_ = 0.0;  ///< start of the present count [s]
  double last_shown_ = 0.0;
  std::string last_step_;
  int steps_ = 0;
};

}  // namespace tissue_stiffness
