#pragma once

#include <atomic>
#include <chrono>
#include <stdexcept>

namespace tissue_stiffness {

/// The work was asked to end before it was finished. This is no failure: the results so far remain valid.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Asks running work to end early, either immediately or when a time limit has passed. Long work gets a StopRequest and
/// calls check() at least once a frame.
class StopRequest {
 public:
  StopRequest() = default;
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// Limits the time of the work to `seconds` from now. It must be called before the work begins.
  void end_after(double seconds) { limit_ = Clock::now() + std::chrono::duration<double>(seconds); }

  /// Asks the work to end now. It may be called from any thread and from a signal handler.
  void stop() noexcept { stopped_ = true; }

  bool stopped() const { return stopped_ || Clock::now() >= limit_; }

  /// Throws Interrupted once the work has to end.
  void check() const {
    if (stopped()) throw Interrupted();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

  std::atomic<bool> stopped_{false};
  std::chrono::time_point<Clock, std::chrono::duration<double>> limit_ =
      std::chrono::time_point<Clock, std::chrono::duration<double>>::max();
};

}  // namespace tissue_stiffness
