#pragma once

#include <ros/time.h>

#include <cstddef>
#include <string>

namespace tissue_stiffness {

/// Returns the seconds from one stamp to another. ros::Duration holds 68 years only, and a broken stamp may be farther off.
inline double seconds_between(const ros::Time& from, const ros::Time& to) {
  return to.toSec() - from.toSec();
}

/// Returns whether a stamp is earlier than the one before by more than messages are that overtake each other: 0.5 s.
bool goes_back(const ros::Time& before, const ros::Time& stamp);
/// Returns whether a stamp follows another of a topic with this interval [s; 0: not known]. It does not when it goes back,
/// and not when it is ahead by more than a pause: a second or five intervals, or a minute where no interval is known.
bool goes_on(const ros::Time& before, const ros::Time& stamp, double interval);
/// Returns the running mean of a topic's intervals [s; 0: not known] with one more.
double smooth_interval(double mean, double interval);
/// Returns "3 s ahead" or "3 s back".
std::string jump(const ros::Time& from, const ros::Time& to);

/// The stamps of one topic that are believed (see StampFilter).
struct TopicStamps {
  bool seen = false;
  ros::Time first, last;
  double interval = 0.0;  ///< between its messages [s], a running mean; 0: not known yet
  ros::Time before;       ///< the stamp before the last one; the first one, where there is none

  bool go_on_with(const ros::Time& stamp) const { return goes_on(last, stamp, interval) || last_was_ahead(stamp); }
  /// Returns whether the stamp goes back from the last one, which was not ahead of its time.
  bool start_over_with(const ros::Time& stamp) const { return goes_back(last, stamp) && !last_was_ahead(stamp); }
  /// Returns whether the stamp goes back from the last one but goes on from the one before. Then the last one was ahead by
  /// less than a pause, and no clock has jumped.
  bool last_was_ahead(const ros::Time& stamp) const {
    return goes_back(last, stamp) && stamp > before && goes_on(before, stamp, interval);
  }
  /// Goes on with a stamp that is believed.
  void advance(const ros::Time& stamp);
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

constexpr std::size_t kAgreeingStamps = 3;  ///< held messages that are believed because their stamps agree
constexpr double kPause = 1.0;              ///< a shorter silence is none [s]
constexpr double kPauses = 5.0;             ///< nor is one of fewer intervals of the topic
constexpr double kJumpAhead = 60.0;         ///< a silence that ends an experiment [s]

}  // namespace tissue_stiffness
