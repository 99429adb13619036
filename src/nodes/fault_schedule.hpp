#pragma once

#include <ros/time.h>

#include <cstdint>
#include <map>
#include <random>
#include <string>

namespace tissue_stiffness {

/// What may happen to a message between a sensor and a node.
enum class Fault { none, drop, delay, duplicate, reorder, corrupt, restamp, mute };

std::string to_string(Fault fault);

struct FaultSettings {
  std::uint32_t seed = 1;
  std::map<Fault, double> rates;  ///< probabilities per message; of a mute: how often it begins [Hz]
  double longest_delay = 0.3;     ///< [s], like all times here: between stamps
  double longest_shift = 5.0;
  double longest_mute = 3.0;
  double quiet = 0.0;  ///< how long none happens, in turns with `active`; 0: they always do
  double active = 0.0;
};

/// Decides which fault each message of one topic has. The decisions depend on the seed, the number of the topic and the
/// stamps alone, so they do not depend on when messages arrive.
class FaultSchedule {
 public:
  FaultSchedule(const FaultSettings& settings, std::uint32_t topic);

  /// Returns the fault of the topic's next message. A mute begins with this message.
  Fault next(const ros::Time& stamp);

  double draw_delay();  ///< [s], up to the longest
  double draw_mute();   ///< [s], up to the longest
  double draw_shift();  ///< [s] ahead or, below 0, back: some seconds, or an hour ahead

  std::mt19937& random() { return random_; }

 private:
  bool is_quiet(const ros::Time& stamp) const;
  double draw(double lower, double upper);

  FaultSettings settings_;
  std::mt19937 random_;
  ros::Time last_;
};

}  // namespace tissue_stiffness
