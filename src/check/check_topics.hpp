#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "check/setup_finding.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// A topic with the ROS type of its messages.
struct Topic {
  std::string name, type;
};

/// A topic that the model file requires.
struct NeededTopic {
  std::string key;  ///< key that names the topic
  Topic topic;
};

/// Returns the topics of observations and loads, each once.
std::vector<NeededTopic> needed_topics(const ModelSettings& settings);

/// Finds needed topics that are not in `there`, or have another type. Suggests the one with the most similar name, and
/// those with this type. `lack`: what lacks the topic, "the recording lacks" or "no node publishes".
SetupFindings check_topics(const std::vector<NeededTopic>& needed, const std::vector<Topic>& there,
                           const std::string& lack);

/// Stamps of a topic's messages and the times at which they were recorded [s], in the order of recording.
struct TopicTimes {
  std::string topic;
  std::vector<double> stamps, arrivals;
};

/// Finds topics that stopped before the last of the others did. They were silent for more than ten times their longest gap
/// until then, and for more than a tenth of the recording.
SetupFindings check_stops(const std::vector<TopicTimes>& topics);

/// Finds clocks that differ. Either a topic's stamps share no instant with those of the first one, or its median lead over
/// the record time differs from the first one's by more than 0.5 s. The reader does not wait longer than that.
SetupFindings check_clocks(const std::vector<TopicTimes>& topics);

/// Finds frames of messages (by topic) that no chain of transforms connects with the model's. `transforms`: parent and
/// child.
SetupFindings check_frames(const std::map<std::string, std::string>& frames,
                           const std::vector<std::pair<std::string, std::string>>& transforms,
                           const std::string& model_frame);

}  // namespace tissue_stiffness
