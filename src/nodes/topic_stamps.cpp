#include "nodes/topic_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tissue_stiffness {
namespace {

constexpr double kJumpBack = 0.5, kPause = 1.0;  // [s]
constexpr double kPauses = 5.0;                  // intervals
constexpr double kSmooth = 0.8;                  // of the interval so far, in its running mean

}  // namespace

bool goes_back(const ros::Time& before, const ros::Time& stamp) {
  return seconds_between(stamp, before) > kJumpBack;
}

bool TopicStamps::ahead(const ros::Time& stamp) const {
  return interval > 0.0 && seconds_between(last, stamp) > std::max(kPause, kPauses * interval);
}

void TopicStamps::advance(const ros::Time& stamp) {
  if (!seen) {
    *this = {true, stamp, stamp, interval};
    return;
  }
  if (stamp <= last) return;
  const double since = seconds_between(last, stamp);
  interval = interval > 0.0 ? kSmooth * interval + (1.0 - kSmooth) * since : since;
  last = stamp;
}

std::string TopicStamps::jump_to(const ros::Time& stamp, const std::string& topic) const {
  const double jump = seconds_between(last, stamp);
  std::ostringstream text;
  text << topic << ": " << std::abs(jump) << (jump < 0.0 ? " s back" : " s ahead");
  return text.str();
}

}  // namespace tissue_stiffness
