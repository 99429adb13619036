#pragma once

#include <string>
#include <vector>

#include "settings/key_spec.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/camera.hpp"

namespace tissue_stiffness {

/// The sensor that took a film.
struct FilmCamera {
  Camera camera;       ///< with its pose
  double rate = 0.0;   ///< frames a second; 0: the film says it
  double start = 0.0;  ///< time of the first frame, by the clock of the CSV files beside the film [s]
};

/// Returns every key of a camera file, in the order of the documentation.
const std::vector<KeySpec>& camera_keys();

/// Reads the calibration that ROS's camera_calibration writes, with the sensor's pose added to it. The projection is the
/// observation's; a slice has pixels a metre in its camera matrix. Throws InputError for a missing or unknown key, and for
/// numbers that are no camera.
FilmCamera read_camera_file(const std::string& file, const ObservationSettings& observation);

}  // namespace tissue_stiffness
