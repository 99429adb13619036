#pragma once

#include <map>
#include <string>
#include <utility>

#include "observation/closest_point.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// Says which point of the body each feature of a camera's images is: the first that its ray meets, from the camera through
/// its pixel in the reference image, of the mesh at rest. The pose is that of the camera when the feature is first seen. A
/// feature is the body's if its whole window is: the rays through the window's corners meet the body, too, beside that
/// point. Otherwise its window also shows something else, which moves in another way.
///
/// A feature that has moved otherwise than those around it was mistaken for another, or a tool covers it. It is left out by
/// the normalised median test (Westerweel & Scarano 2005, Exp. Fluids 39): its motion differs from the median of its
/// neighbours' by more than `kOtherwise` times the median difference of these.
class FeatureAnchors {
 public:
  explicit FeatureAnchors(TetMesh mesh) : mesh_(std::move(mesh)) {}

  /// Turns tracks into an observation of entry `source`. Their pixels are those of the undistorted image. Throws
  /// InputError, which names the topic, when no feature is the body's.
  Observation observe(const FeatureTracks& tracks, const Camera& camera, int source, const std::string& topic);

 private:
  struct Anchor {
    Eigen::Vector2d reference;  ///< [pixel]
    SurfacePoint place;
  };
  const SurfacePoint& place(const FeatureTracks& tracks, Eigen::Index i, const Camera& camera);
  SurfacePoint meet(const Eigen::Vector2d& pixel, const Camera& camera) const;
  bool shows_body_alone(const SurfacePoint& place, const Eigen::Vector2d& reference, double window,
                        const Camera& camera) const;

  TetMesh mesh_;
  std::map<int, Anchor> anchors_;  ///< by the feature's number
};

/// Returns one for each of the model's observations of tracks, by index in the list.
std::map<int, FeatureAnchors> make_feature_anchors(const ModelSettings& settings, const TetMesh& mesh);

}  // namespace tissue_stiffness
