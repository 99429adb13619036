#include "nodes/topic_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tissue_stiffness {
namespace {

constexpr double kJumpBack = 0.5;  // [s]
constexpr double kSmooth = 0.8;    // of the interval so far, in its running mean

}  // namespace

bool goes_back(const ros::Time& before, const ros::Time& stamp) {
  return seconds_between(stamp, before) > kJumpBack;
}

bool goes_on(const ros::Time& before, const ros::Time& stamp, double interval) {
  const double longest = interval > 0.0 ? std::max(kPause, kPauses * interval) : kJumpAhead;
  return !goes_back(before, stamp) && seconds_between(before, stamp) <= longest;
}

double smooth_interval(double mean, double interval) {
  return mean > 0.0 ? kSmooth * mean + (1.0 - kSmooth) * interval : interval;
}

std::string jump(const ros::Time& from, const ros::Time& to) {
  const double seconds = seconds_between(from, to);
  std::ostringstream text;
  text << std::abs(seconds) << (seconds < 0.0 ? " s back" : " s ahead");
  return text.str();
}

void TopicStamps::advance(const ros::Time& stamp) {
  if (!seen) {
    *this = {true, stamp, stamp, interval, stamp};
    return;
  }
  if (last_was_ahead(stamp)) last = before;
  if (stamp <= last) return;
  interval = smooth_interval(interval, seconds_between(last, stamp));
  before = last;
  last = stamp;
}

}  // namespace tissue_stiffness
