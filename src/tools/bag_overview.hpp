#pragma once

#include <map>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

#include "check/check_topics.hpp"

namespace tissue_stiffness {

/// Content of a bag, whether or not it fits a model.
struct BagOverview {
  std::vector<Topic> topics;
  std::vector<TopicTimes> times;              ///< of the needed topics that are there, without camera_info
  std::map<std::string, std::string> frames;  ///< frame_id of each topic's first message
  std::vector<std::pair<std::string, std::string>> transforms;  ///< parent and child on /tf and /tf_static, each pair once
  std::map<std::string, std::vector<cv::Mat>> images;           ///< up to five for each topic, evenly over the bag
};

/// Reads the overview. Throws InputError for a file that is missing or not a bag.
BagOverview overview(const std::string& file, const std::vector<NeededTopic>& needed);

}  // namespace tissue_stiffness
