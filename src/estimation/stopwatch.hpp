#pragma once

#include <chrono>
#include <map>
#include <string>

namespace tissue_stiffness {

/// A stopwatch adds up the wall time of a step's stages.
class Stopwatch {
 public:
  explicit Stopwatch(std::map<std::string, double>& seconds) : seconds_(seconds), last_(Clock::now()) {}
  /// Adds the time since the last lap to `stage` [s].
  void lap(const std::string& stage) {
    const Clock::time_point now = Clock::now();
    seconds_[stage] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::map<std::string, double>& seconds_;
  Clock::time_point last_;
};

}  // namespace tissue_stiffness
