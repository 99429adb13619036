#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// A quantity that is measured and predicted over the kept frames: the position of a tracked point, or the edges of an
/// outline.
struct ReplayTrack {
  std::string name;                     ///< "vertex 12", "outline 1"
  std::string unit;                     ///< m, N or pixel
  std::vector<std::string> components;  ///< x, y, z of a point; left, right, top, bottom of an outline; distance
  Eigen::MatrixXd measured, predicted;  ///< components x frames; NaN where there is no value
};

/// The model's surface over the frames, as plane triangles, with its distance from the measurement.
struct ReplaySurface {
  Eigen::Matrix3Xd rest;                       ///< [m]
  Eigen::Matrix3Xi triangles;                  ///< counter-clockwise seen from outside
  std::vector<int> frames;                     ///< which of the replay's frames the lists below hold, ascending
  std::vector<Eigen::Matrix3Xd> displacement;  ///< one matrix for each of these frames [m]
  std::vector<Eigen::VectorXd> error, sigmas;  ///< rms misfit at each vertex [m], and over sigma; NaN: not measured
};

/// Measured and predicted outline in one image.
struct ReplayOutline {
  int source = 0;             ///< index in the model file's list `observations`
  double time = 0.0;          ///< [s] since the first stamp
  int width = 0, height = 0;  ///< size of the image [pixel]
  Eigen::Matrix2Xd measured;  ///< points along the outline, or features [pixel]
  bool closed = true;
  Eigen::Matrix4Xd predicted;  ///< separate pieces (u0, v0, u1, v1), or each feature's displacement since rest [pixel]
  bool joined = true;          ///< false: the points are features
};

/// What acts on the body at a place, over the kept frames: the force of a load, or a prescribed motion.
struct ReplayLoad {
  std::string name;       ///< the effect and its region
  std::string unit;       ///< N, or m of a prescribed motion
  Eigen::Vector3d place;  ///< at rest [m]
  Eigen::Matrix3Xd value;
};

/// The free run of a model compared with its recording, with few enough frames to be shown.
struct Replay {
  std::string name;          ///< name of the model
  std::vector<double> time;  ///< times of the kept frames [s], since the first stamp
  std::vector<double> rms;   ///< error of each of these frames [m]
  std::vector<ReplayTrack> tracks;
  ReplaySurface surface;
  std::vector<ReplayOutline> outlines;  ///< outlines at the times of the camera images
  std::vector<ReplayLoad> loads;
  Eigen::Matrix3Xd held;  ///< places at rest that a support holds, few enough to be shown [m]
};

/// A camera image at reduced size.
struct Picture {
  int source = 0;      ///< index in the model file's list `observations`
  double stamp = 0.0;  ///< [s] on the recording's clock
  std::string jpeg;    ///< content of the JPEG file
};

/// Animated content of a report: runs of one or several models, and images of the recording.
struct Showing {
  double first_stamp = 0.0;  ///< [s] on the recording's clock; the replays' times count from it
  std::vector<Replay> replays;
  std::vector<Picture> pictures;
};

}  // namespace tissue_stiffness
