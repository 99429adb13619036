#include "nodes/fault_schedule.hpp"

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kHour = 3600.0;          // [s]
constexpr double kLongestInterval = 1.0;  // [s] a pause of the topic makes no mute more probable

}  // namespace

std::string to_string(Fault fault) {
  switch (fault) {
    case Fault::none:
      return "none";
    case Fault::drop:
      return "drop";
    case Fault::delay:
      return "delay";
    case Fault::duplicate:
      return "duplicate";
    case Fault::reorder:
      return "reorder";
    case Fault::corrupt:
      return "corrupt";
    case Fault::restamp:
      return "restamp";
    case Fault::mute:
      return "mute";
  }
  return "";
}

FaultSchedule::FaultSchedule(const FaultSettings& settings, std::uint32_t topic) : settings_(settings) {
  std::seed_seq seed{settings.seed, topic};
  random_.seed(seed);
}

Fault FaultSchedule::next(const ros::Time& stamp) {
  const double interval = std::clamp(stamp.toSec() - last_.toSec(), 0.0, kLongestInterval);
  last_ = stamp;
  double left = draw(0.0, 1.0);  // also while it is quiet, so that pauses do not change what follows
  if (is_quiet(stamp)) return Fault::none;
  for (const auto& [fault, rate] : settings_.rates) {
    left -= fault == Fault::mute ? rate * interval : rate;
    if (left < 0.0) return fault;
  }
  return Fault::none;
}

bool FaultSchedule::is_quiet(const ros::Time& stamp) const {
  if (settings_.quiet == 0.0) return false;
  return std::fmod(stamp.toSec(), settings_.quiet + settings_.active) < settings_.quiet;
}

double FaultSchedule::draw_delay() {
  return draw(0.0, settings_.longest_delay);
}

double FaultSchedule::draw_mute() {
  return draw(0.0, settings_.longest_mute);
}

double FaultSchedule::draw_shift() {
  const double seconds = draw(0.0, settings_.longest_shift);
  const double choice = draw(0.0, 3.0);
  return choice < 1.0 ? seconds : choice < 2.0 ? -seconds : kHour;
}

double FaultSchedule::draw(double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random_);
}

}  // namespace tissue_stiffness
