#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/contour.hpp"

namespace tissue_stiffness {

enum class ObservationKind { vertices, markers, points, contour };

/// What one sensor saw at one instant. `source` is the row of the model file's `observations` list.
struct Observation {
  int source = 0;
  ObservationKind kind = ObservationKind::vertices;
  double time = 0.0;                       ///< [s] on the recording's clock
  Eigen::Matrix3Xd points;                 ///< positions in the model frame [m]; empty for a contour
  Eigen::VectorXi ids;                     ///< mesh vertex (vertices) or row of `rest` (markers); empty otherwise
  std::shared_ptr<const Contour> contour;  ///< only for contour
  std::shared_ptr<const Camera> camera;    ///< only for contour
};

/// All observations of one instant: what the estimator steps over.
struct Frame {
  double time = 0.0;  ///< [s] on the recording's clock
  std::vector<Observation> observations;
};

}  // namespace tissue_stiffness
