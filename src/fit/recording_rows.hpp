#pragma once

#include <Eigen/Core>
#include <vector>

#include "fit/frame_rows.hpp"
#include "observation/frame_misfit.hpp"
#include "tissue_stiffness/fit/recording.hpp"

namespace tissue_stiffness {

/// All rows of all frames of a free run, in sigmas. `used` is 0 where a row says nothing, else the root of its robust
/// weight.
struct RecordingRows {
  Eigen::VectorXd error;      ///< (measured - predicted) / sigma, times used
  Eigen::VectorXd predicted;  ///< predicted / sigma
  Eigen::VectorXd used;
  Eigen::VectorXd sigma;    ///< [m], or [N] of a force
  Eigen::VectorXi nodes;    ///< nearest mesh node, or kForceRow
  Eigen::Matrix3Xd places;  ///< where each row was measured [m]
  FrameRows frames;

  /// Returns the number of rows that say something.
  double count() const { return static_cast<double>((used.array() > 0.0).count()); }
  /// Returns whether a row says something of a length, and not of a force.
  bool tells_length(Eigen::Index row) const { return used[row] > 0.0 && nodes[row] != kForceRow; }
};

/// Returns the rows of all frames from their predictions.
RecordingRows recording_rows(const std::vector<Prediction>& predictions);

/// Returns by how much the rows' predictions differ from the first frame's [sigma]; 0 in frames with another number of
/// rows.
Eigen::VectorXd motion_of(const RecordingRows& rows);

/// Returns the sum of the rows' squared errors beyond the stated noise [sigma^2], or 0.
double structured_squares(const RecordingRows& rows);

/// Returns the root mean square of the lengths' errors over held-out (true) or training (false) frames [m]; 0 without any.
double rms_error(const RecordingRows& rows, const Recording& recording, bool held_out);
/// Returns the same over all frames.
double rms_error(const RecordingRows& rows);
/// Returns the root mean square of the noise that the model file states [m].
double noise_floor(const RecordingRows& rows);

}  // namespace tissue_stiffness
