#pragma once

#include <ros/time.h>

#include <cstddef>
#include <string>

namespace tissue_stiffness {

/// Returns whether a stamp is earlier than the one before by more than messages are that overtake each other: 0.5 s.
bool goes_back(const ros::Time& before, const ros::Time& stamp);

/// Returns the seconds from one stamp to another. ros::Duration holds 68 years only, and a broken stamp may be farther off.
inline double seconds_between(const ros::Time& from, const ros::Time& to) {
  return to.toSec() - from.toSec();
}

/// The stamps of one topic. A clock that jumps stamps many messages, and a broken message is alone. So a message whose
/// stamp jumps is held back until more of its topic agree. A message that goes on where the topic was before shows that the
/// held ones are broken.
struct TopicStamps {
  bool seen = false;
  ros::Time first, last;
  double interval = 0.0;  ///< between its messages [s], a running mean; 0: not known yet

  bool back(const ros::Time& stamp) const { return goes_back(last, stamp); }
  /// Returns whether the stamp is ahead by more than a pause would be: a second, or five of the topic's intervals.
  bool ahead(const ros::Time& stamp) const;
  /// Goes on with a stamp that is believed.
  void advance(const ros::Time& stamp);
  /// Returns "TOPIC: 3 s ahead".
  std::string jump_to(const ros::Time& stamp, const std::string& topic) const;
};

/// Keeps at most `rate` messages a second [Hz] of a topic.
class RateLimit {
 public:
  explicit RateLimit(double rate) : interval_(kSlack / rate) {}
  /// Returns whether a message with this stamp is kept. After a jump back it is.
  bool keep(const ros::Time& stamp) {
    if (any_ && stamp >= last_ && seconds_between(last_, stamp) < interval_) return false;
    any_ = true;
    last_ = stamp;
    return true;
  }

 private:
  static constexpr double kSlack = 0.99;  // stamps of a sensor at this very rate jitter
  double interval_;
  bool any_ = false;
  ros::Time last_;
};

constexpr std::size_t kAgreeingStamps = 3;  ///< messages whose stamps agree that the clock has jumped

}  // namespace tissue_stiffness
