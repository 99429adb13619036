#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/contour.hpp"

namespace tissue_stiffness {

enum class ObservationKind { vertices, markers, points, contour };

/// The measurement of one sensor at one instant. `source` is the index of its entry in the model file's list
/// `observations`.
struct Observation {
  int source = 0;
  ObservationKind kind = ObservationKind::vertices;
  double time = 0.0;                       ///< [s] on the recording's clock
  Eigen::Matrix3Xd points;                 ///< positions in the model frame [m]; empty for a contour
  Eigen::VectorXi ids;                     ///< mesh vertex (vertices) or index in `rest` (markers); empty otherwise
  std::shared_ptr<const Contour> contour;  ///< only for contour
  std::shared_ptr<const Camera> camera;    ///< only for contour
};

/// All observations of one instant; the estimator makes one step for each frame.
struct Frame {
  double time = 0.0;  ///< [s] on the recording's clock
  std::vector<Observation> observations;
};

}  // namespace tissue_stiffness
