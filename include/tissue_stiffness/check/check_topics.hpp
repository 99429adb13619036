#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/check/setup_finding.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// A topic with the ROS type of its messages.
struct Topic {
  std::string name, type;
};

/// A topic that the model file asks for.
struct NeededTopic {
  std::string key;  ///< that names it
  Topic topic;
};

/// Topics of observations and loads, each once.
std::vector<NeededTopic> needed_topics(const ModelSettings& settings);

/// Needed topics that are not among those there are, or are of another type. Suggests the one of the most similar name, and
/// those of the same type. `lack`: what lacks it, "the recording lacks" or "no node publishes".
SetupFindings check_topics(const std::vector<NeededTopic>& needed, const std::vector<Topic>& there,
                           const std::string& lack);

/// When a topic's messages were stamped and when they were recorded [s], in the order in which they were recorded.
struct TopicTimes {
  std::string topic;
  std::vector<double> stamps, arrivals;
};

/// Topics that stopped before the last of the others did: for more than ten times their longest gap until then, and for
/// more than a tenth of the recording.
SetupFindings check_stops(const std::vector<TopicTimes>& topics);

/// Clocks that are apart. Stamps of a topic that share no instant with those of the first one, or whose median lead over
/// the record time differs from the first one's by more than 0.5 s, for which the reader does not wait.
SetupFindings check_clocks(const std::vector<TopicTimes>& topics);

/// Frames of messages (by topic) that no chain of transforms joins with the model's. `transforms`: parent and child.
SetupFindings check_frames(const std::map<std::string, std::string>& frames,
                           const std::vector<std::pair<std::string, std::string>>& transforms,
                           const std::string& model_frame);

}  // namespace tissue_stiffness
