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

/// A film of one of the model's contours, and the file of the camera that took it (see read_camera_file).
struct PackedFilm {
  std::string film, camera;
};

/// What was recorded without ROS.
struct PackedFiles {
  std::vector<PackedTopic> topics;
  std::vector<PackedFilm> films;  ///< one for each contour of the model, in its order
  double scale = 1.0;             ///< converts the CSV files' lengths to metres
};

/// Writes a bag in the model's frame from CSV files and films, so that every tool and node reads what was recorded without
/// ROS. Each row begins with a time [s]; the bag begins at the earliest one. Then follow
///   vertices, markers: number, x, y, z      points: x, y, z         (rows of one time are one message)
///   a wrench, a reaction: fx, fy, fz, and the torque if there is one [N], [N m]
///   a pressure: p [Pa]                      a pose: x, y, z, qx, qy, qz, qw
/// The frames of a film follow one another at its rate. They are grey, unless the model tells its body by a colour.
///
/// Throws InputError for a topic that the model does not have or whose messages are images, and for a row that does not
/// fit. It does so, too, for films that are not those of the model's contours, or not of their cameras' size.
std::vector<PackedSummary> pack_recording(const ModelSettings& settings, const PackedFiles& files, const std::string& bag);

}  // namespace tissue_stiffness
