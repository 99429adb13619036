#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tools/load_signal.hpp"

namespace tissue_stiffness {

/// A measured load, which is a sum of terms and is published at a rate. `direction` times a term's magnitude is the value.
/// It is 1 for a pressure, and force and torque in the model frame for a wrench. For a pose it is a displacement [m] and a
/// rotation vector [rad], and the value is that of pose_values.
struct LoadScene {
  struct Term {
    Eigen::VectorXd direction;
    Signal signal;
  };
  LoadInput input;
  std::vector<Term> terms;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of a pose before it moves [m]
  double rate = 0.0;                                   ///< [Hz]
  double noise = 0.0;  ///< 1 sigma of the published load; the acting load has none [N, Pa or m]

  Eigen::VectorXd value(double time) const;
};

/// Properties of a sensor's images.
struct ImageScene {
  Camera camera;
  double noise = 3.0;  ///< 1 sigma of the grey value, 0-255
  double blur = 0.8;   ///< 1 sigma of the optics [pixel]
  bool fine = false;   ///< whether the body's texture is as fine as the pixels, or as the mesh
  // The following members are for B-mode only.
  Eigen::Vector2d apex = Eigen::Vector2d::Zero();  ///< apex of the sector [pixel]
  double sector = 0.0;                             ///< full angle of the sector [rad]
  double depth = 0.0;                              ///< depth of the sector [pixel]
  double drop_out = 0.0;                           ///< part of the wall's beams that is lost, 0 to 0.5
};

/// How one entry of `observations` is recorded.
struct SensorScene {
  double noise = 0.0;         ///< for clouds, 1 sigma of a coordinate [m]; for a reaction [N]
  double memory = 0.0;        ///< correlation of a tracked point's noise from one frame to the next
  int every = 1;              ///< each `every`-th vertex of the surface is recorded, in ascending order
  std::vector<int> vertices;  ///< vertices of the file's mesh; used instead of `every` if not empty
  int points = 0;             ///< number of random points on the surface in each frame
  std::optional<ImageScene> image;
};

/// A scene file. It is a model file whose numbers are all known, with `simulation`, which says how it is run and recorded.
///
///     simulation:
///       duration: 3            # s
///       rate: 30               # frames/s
///       step: 0.001            # integration step [s]
///       refine: 1              # number of refinements of the mesh (default 0)
///       spectral_radius: 1     # of generalised-alpha (default 1: Newmark's average acceleration)
///       seed: 1                # of all noise (default 1)
///       loads:                 # one entry for each `topic` of an effect
///         /tool/wrench: {rate: 200, noise: 0,
///                        terms: [{direction: [0, 0, -1], raised_cosine: {amplitude: 2, frequency: 1}}]}
///         /tissue/pressure: {rate: 200, terms: [{sine: {amplitude: 100, frequency: 1}}]}
///       sensors:               # one entry for each contour and for tracks; others may have one
///         # or ids: [..]; default: every surface vertex, the model's noise
///         /tissue/vertices: {every: 3, noise: 1e-4, memory: 0.5}
///         /tissue/points: {count: 500}
///         /camera/image_raw: {size: [640, 480], focal_length: 2500, position: [0, -1, 0], target: [0, 0, 0],
///                             up: [0, 0, 1]}
///         # degrees, m
///         /ultrasound/image_raw: {size: [640, 480], pixels_per_metre: 3500, apex: [0, 0, -0.08], axis: [0, 0, 1],
///                                 lateral: [1, 0, 0], sector: 78, depth: 0.128, drop_out: 0.1}
struct Scene {
  ModelSettings model;
  double duration = 0.0, rate = 0.0, step = 0.0, spectral_radius = 1.0;
  int refine = 0;
  std::uint64_t seed = 1;
  std::vector<LoadScene> loads;
  std::vector<SensorScene> sensors;  ///< one for each observation
};

/// Reads a scene file. Throws InputError for an unknown, missing or out-of-range key, a topic without its load or image,
/// and a load that no effect uses.
Scene load_scene(const std::string& file);

}  // namespace tissue_stiffness
