#include "nodes/topic_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tissue_stiffness {
namespace {

const ros::Duration kJumpBack(0.5);
const ros::Duration kPause(1.0);
constexpr double kPauses = 5.0;  // intervals
constexpr double kSmooth = 0.8;  // of the interval so far, in its running mean

}  // namespace

bool goes_back(const ros::Time& before, const ros::Time& stamp) {
  return stamp + kJumpBack < before;
}

bool TopicStamps::ahead(const ros::Time& stamp) const {
  return !interval.isZero() && stamp > last + std::max(kPause, interval * kPauses);
}

void TopicStamps::advance(const ros::Time& stamp) {
  if (!seen) {
    *this = {true, stamp, stamp, interval};
    return;
  }
  if (stamp <= last) return;
  const ros::Duration since = stamp - last;
  interval = interval.isZero() ? since : interval * kSmooth + since * (1.0 - kSmooth);
  last = stamp;
}

std::string TopicStamps::jump_to(const ros::Time& stamp, const std::string& topic) const {
  const double jump = (stamp - last).toSec();
  std::ostringstream text;
  text << topic << ": " << std::abs(jump) << (jump < 0.0 ? " s back" : " s ahead");
  return text.str();
}

}  // namespace tissue_stiffness
