#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "tissue_stiffness/forward/model.hpp"
#include "tissue_stiffness/tools/scene.hpp"

namespace tissue_stiffness {

/// Draws the image that a sensor would take of the body.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// `positions`: the mesh's nodes, displaced [m]. CV_8UC1. The same frame number gives the same noise.
  virtual cv::Mat draw(const Eigen::Matrix3Xd& positions, int frame) const = 0;
};

/// A textured body, shaded by a light above the camera, in front of a cloudy background and the floor of a contact plane.
std::unique_ptr<Renderer> make_camera_renderer(const Model& model, const ImageScene& scene, std::uint64_t seed);

/// B-mode sector: a bright wall, the dark pool inside the region's outline, tissue around, all speckled; lost beams.
std::unique_ptr<Renderer> make_echo_renderer(const Model& model, const ObservationSettings& observation,
                                             const ImageScene& scene, std::uint64_t seed);

}  // namespace tissue_stiffness
