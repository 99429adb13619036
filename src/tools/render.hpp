#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "forward/model.hpp"
#include "tools/scene.hpp"

namespace tissue_stiffness {

/// Draws the image that a sensor would record of the body.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// Returns a CV_8UC1 image. `positions`: the mesh's nodes, displaced [m]. Equal frame numbers give equal noise.
  virtual cv::Mat draw(const Eigen::Matrix3Xd& positions, int frame) const = 0;
};

/// Draws a textured body, shaded by a light above the camera, in front of a cloudy background and the floor of a contact
/// plane.
std::unique_ptr<Renderer> make_camera_renderer(const Model& model, const ImageScene& scene, std::uint64_t seed);

/// Draws a B-mode sector with speckle and lost beams: a bright wall, the dark pool inside the region's outline, and tissue
/// around.
std::unique_ptr<Renderer> make_echo_renderer(const Model& model, const ObservationSettings& observation,
                                             const ImageScene& scene, std::uint64_t seed);

}  // namespace tissue_stiffness
