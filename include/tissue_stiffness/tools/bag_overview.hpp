#pragma once

#include <map>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/check/check_topics.hpp"

namespace tissue_stiffness {

/// What a bag holds, before anybody asks whether that fits a model.
struct BagOverview {
  std::vector<Topic> topics;
  std::vector<TopicTimes> times;                                ///< of the needed topics that are there; no camera_info
  std::map<std::string, std::string> frames;                    ///< frame_id of the first message, by topic
  std::vector<std::pair<std::string, std::string>> transforms;  ///< parent and child on /tf and /tf_static, each once
  std::map<std::string, std::vector<cv::Mat>> images;           ///< up to five, evenly over the bag, by topic
};

/// Throws InputError for a file that is missing or no bag.
BagOverview overview(const std::string& file, const std::vector<NeededTopic>& needed);

}  // namespace tissue_stiffness
