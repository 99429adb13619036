#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/tools/load_signal.hpp"
#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/load_sample.hpp"

namespace tissue_stiffness {

/// A measured load: a sum of terms, published at a rate. `direction` turns a term's magnitude into the value: 1 for a
/// pressure, force and torque in the model frame for a wrench.
struct LoadScene {
  struct Term {
    Eigen::VectorXd direction;
    Signal signal;
  };
  LoadInput input;
  std::vector<Term> terms;
  double rate = 0.0;   ///< [Hz]
  double noise = 0.0;  ///< 1-sigma of what is published; what acts is without [Pa or N]

  Eigen::VectorXd value(double time) const;
};

/// How images look.
struct ImageScene {
  Camera camera;
  double noise = 3.0;  ///< 1-sigma of the grey value, 0-255
  double blur = 0.8;   ///< 1-sigma of the optics [pixel]
  // B-mode only
  Eigen::Vector2d apex = Eigen::Vector2d::Zero();  ///< of the sector [pixel]
  double sector = 0.0;                             ///< full angle [rad]
  double depth = 0.0;                              ///< [pixel]
  double drop_out = 0.0;                           ///< part of the wall's beams that are lost, 0 to 0.5
};

/// How one entry of `observations` is recorded.
struct SensorScene {
  double noise = 0.0;         ///< of clouds, 1-sigma a coordinate [m]
  double memory = 0.0;        ///< correlation of a tracked point's noise from one frame to the next
  int every = 1;              ///< of the surface's vertices, in ascending order
  std::vector<int> vertices;  ///< of the mesh in the file; instead of `every` when not empty
  int points = 0;             ///< random points of the surface in a frame
  std::optional<ImageScene> image;
};

/// A scene file: a model file whose numbers are all known, and `simulation`: how it is run and recorded.
///
///     simulation:
///       duration: 3            # s
///       rate: 30               # frames/s
///       step: 0.001            # integration step [s]
///       refine: 1              # how often the mesh is refined (default 0)
///       spectral_radius: 1     # of generalised-alpha (default 1: Newmark's average acceleration)
///       seed: 1                # of all noise (default 1)
///       loads:                 # one entry for each `topic` of an effect
///         /tool/wrench: {rate: 200, noise: 0, terms: [{direction: [0, 0, -1], raised_cosine: {amplitude: 2, frequency:
///         1}}]} /tissue/pressure: {rate: 200, terms: [{sine: {amplitude: 100, frequency: 1}}]}
///       sensors:               # one entry for each contour; others may have one
///         /tissue/vertices: {every: 3, noise: 1e-4, memory: 0.5}  # or ids: [..]; default: every surface vertex, the
///         model's noise /tissue/points: {count: 500} /camera/image_raw: {size: [640, 480], focal_length: 2500, position:
///         [0, -1, 0], target: [0, 0, 0], up: [0, 0, 1]} /ultrasound/image_raw: {size: [640, 480], pixels_per_metre: 3500,
///         apex: [0, 0, -0.08], axis: [0, 0, 1],
///                                 lateral: [1, 0, 0], sector: 78, depth: 0.128, drop_out: 0.1}   # degrees, m
struct Scene {
  ModelSettings model;
  double duration = 0.0, rate = 0.0, step = 0.0, spectral_radius = 1.0;
  int refine = 0;
  std::uint64_t seed = 1;
  std::vector<LoadScene> loads;
  std::vector<SensorScene> sensors;  ///< one an observation
};

/// Throws InputError for an unknown, missing or out-of-range key, a topic without its load or image, a load that no effect
/// listens to.
Scene load_scene(const std::string& file);

}  // namespace tissue_stiffness
