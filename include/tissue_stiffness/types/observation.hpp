#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/contour.hpp"
#include "tissue_stiffness/types/feature_tracks.hpp"

namespace tissue_stiffness {

enum class ObservationKind { vertices, markers, points, contour, tracks, reaction };
constexpr ObservationKind kObservationKinds[] = {ObservationKind::vertices, ObservationKind::markers,
                                                 ObservationKind::points,   ObservationKind::contour,
                                                 ObservationKind::tracks,   ObservationKind::reaction};

/// What all observations of a kind have in common.
struct ObservationTraits {
  const char* name;     ///< its key in the model file
  bool identified;      ///< its points have numbers: each is a point of the body
  bool image;           ///< it is found in images, seen by a camera
  bool force;           ///< it is a force [N], of three rows; what is said of positions and lengths leaves it out
  bool since_rest;      ///< it shows the motion since rest alone, whatever is off at rest
  int rows;             ///< that each point gives
  const char* message;  ///< type of its ROS messages
};
const ObservationTraits& traits_of(ObservationKind kind);

/// The measurement of one sensor at one instant. `source` is the index of its entry in the model file's list
/// `observations`.
struct Observation {
  int source = 0;
  ObservationKind kind = ObservationKind::vertices;
  double time = 0.0;  ///< [s] on the recording's clock
  /// Positions in the model frame [m]; those at rest for tracks; a reaction: its force [N]; empty for a contour.
  Eigen::Matrix3Xd points;
  Eigen::VectorXi ids;  ///< mesh vertex (vertices), index in `rest` (markers) or feature (tracks); empty otherwise
  std::shared_ptr<const Contour> contour;       ///< only for contour
  std::shared_ptr<const FeatureTracks> tracks;  ///< only for tracks, in the order of `points`
  std::shared_ptr<const Camera> camera;         ///< only for contour and tracks

  /// Returns the number of rows that it gives.
  Eigen::Index row_count() const;
  /// Returns whether some point or some piece of the contour has a number.
  bool holds_anything() const;
};

/// All observations of one instant; the estimator makes one step for each frame.
struct Frame {
  double time = 0.0;  ///< [s] on the recording's clock
  std::vector<Observation> observations;
};

}  // namespace tissue_stiffness
