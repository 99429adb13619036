#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// A topic of the model, and the CSV file whose rows become its messages.
struct PackedTopic {
  std::string topic, file;
};

/// Returns what "TOPIC=FILE" names. Throws InputError for another text.
PackedTopic read_packed_topic(const std::string& text);

struct PackedSummary {
  std::string topic;
  std::size_t messages = 0;
  double duration = 0.0;  ///< [s]
};

/// Writes a bag in the model's frame from CSV files, so that every tool and node reads what was recorded without ROS. Each
/// row begins with a time [s]; the bag begins at the earliest one. Then follow
///   vertices, markers: number, x, y, z      points: x, y, z         (rows of one time are one message)
///   a wrench, a reaction: fx, fy, fz, and the torque if there is one [N], [N m]
///   a pressure: p [Pa]                      a pose: x, y, z, qx, qy, qz, qw
/// `scale` converts the file's lengths to metres. Throws InputError for a topic that the model does not have, or whose
/// messages are images, and for a row that does not fit.
std::vector<PackedSummary> pack_recording(const ModelSettings& settings, const std::vector<PackedTopic>& topics,
                                          double scale, const std::string& bag);

}  // namespace tissue_stiffness
