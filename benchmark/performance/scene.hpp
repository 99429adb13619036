#pragma once

#include <random>
#include <string>
#include <vector>

#include "verification/experiment.hpp"

namespace tissue_stiffness {

/// A block of 0.10 x 0.04 x 0.04 m, 60 kPa, held at one end and let go under gravity, filmed at 30 Hz through 500 markers
/// on its skin (1500 coordinates, 0.3 mm noise). Its tip swings by a third of its length. 10-node tetrahedra.
struct Scene {
  enum class Law { linear, neo_hookean };
  Law law;
  TetMesh mesh;
  ModelSettings settings;
  std::vector<int> marked_facets;  ///< a marker each, at the centroid of its corners
};

constexpr double kTruth = 60e3, kMarkerNoise = 3e-4, kFrameInterval = 1.0 / 30.0;

/// `cells` along the block; the other two sides are cut in proportion, `across` each. The estimate starts at a factor of
/// `start` from the truth.
Scene make_scene(Scene::Law law, int cells, int across, double start = 1.5);

/// `count` frames, the first one interval after the release, of a body with Young's modulus `truth` [Pa].
std::vector<Frame> film(const Scene& scene, int count, double truth = kTruth, unsigned seed = 1);
/// The motion of the whole body in these frames, in full, 3n in each column [m].
Eigen::MatrixXd move(const Scene& scene, int count, double truth);

}  // namespace tissue_stiffness
