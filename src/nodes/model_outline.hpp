#pragma once

#include <vector>

#include "observation/outline.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/contour.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// The model's outline in the image of one contour observation, to be drawn over the image.
class ModelOutline {
 public:
  /// Throws InputError for a region that the mesh does not have.
  ModelOutline(const ModelSettings& settings, const ObservationSettings& observation, const TetMesh& mesh);

  /// Returns the outline at nodal positions [m], with points at most 4 pixels apart. Separate pieces are divided by a NaN
  /// point; sigma is 0.
  Contour seen_by(const Camera& camera, const Eigen::Matrix3Xd& positions) const;

 private:
  bool slice_ = false;
  bool cavity_ = false;
  SurfaceTriangles triangles_;
  std::vector<SurfaceEdge> edges_;
};

}  // namespace tissue_stiffness
