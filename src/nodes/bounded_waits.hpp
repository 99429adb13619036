#pragma once

#include <chrono>
#include <map>
#include <string>

namespace tissue_stiffness {

/// Decides how long to wait for what may never come, by its name: for `patience`, and after a vain wait not at all during
/// ten times as long. So waiting takes a tenth of the time at most, whatever does not come.
class BoundedWaits {
 public:
  using Clock = std::chrono::steady_clock;

  explicit BoundedWaits(Clock::duration patience) : patience_(patience) {}

  /// Returns when a wait that begins `now` has to end.
  Clock::time_point until(const std::string& name, Clock::time_point now) const {
    const auto vain = ended_in_vain_.find(name);
    return vain != ended_in_vain_.end() && now < vain->second + kRest * patience_ ? now : now + patience_;
  }
  /// Tells that a wait of this length ended in vain.
  void in_vain(const std::string& name, Clock::time_point begun, Clock::time_point now) {
    if (now >= begun + patience_) ended_in_vain_[name] = now;
  }

 private:
  static constexpr int kRest = 10;

  Clock::duration patience_;
  std::map<std::string, Clock::time_point> ended_in_vain_;
};

}  // namespace tissue_stiffness
