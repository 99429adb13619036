#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// A quantity measured and predicted over the kept frames: a tracked point's position, an outline's edges.
struct ReplayTrack {
  std::string name;                     ///< "vertex 12", "outline 1"
  std::string unit;                     ///< m or pixel
  std::vector<std::string> components;  ///< x, y, z of a point; left, right, top, bottom of an outline; distance
  Eigen::MatrixXd measured, predicted;  ///< components x frames; NaN where there is none
};

/// The model's surface over the frames, as plain triangles, with its distance from the measurement.
struct ReplaySurface {
  Eigen::Matrix3Xd rest;                       ///< [m]
  Eigen::Matrix3Xi triangles;                  ///< counter-clockwise from outside
  std::vector<int> frames;                     ///< of the replay, ascending, that the lists below speak of
  std::vector<Eigen::Matrix3Xd> displacement;  ///< [m]
  std::vector<Eigen::VectorXd> error, sigmas;  ///< rms misfit at each vertex [m], over sigma; NaN: nothing measured there
};

/// Measured and predicted outline in one image.
struct ReplayOutline {
  int source = 0;             ///< entry of the model file's observations
  double time = 0.0;          ///< [s] since the first stamp
  int width = 0, height = 0;  ///< of the image [pixel]
  Eigen::Matrix2Xd measured;  ///< along the outline [pixel]
  bool closed = true;
  Eigen::Matrix4Xd predicted;  ///< separate pieces (u0, v0, u1, v1) [pixel]
};

/// The free run of a model beside its recording, thinned for showing.
struct Replay {
  std::string name;          ///< of the model
  std::vector<double> time;  ///< of the kept frames [s] since the first stamp
  std::vector<double> rms;   ///< error of each [m]
  std::vector<ReplayTrack> tracks;
  ReplaySurface surface;
  std::vector<ReplayOutline> outlines;  ///< at the instants of the pictures
};

/// A camera image, small.
struct Picture {
  int source = 0;      ///< entry of the model file's observations
  double stamp = 0.0;  ///< [s] on the recording's clock
  std::string jpeg;    ///< the file's bytes
};

/// What a report moves: runs of one model or several, and images of the same recording.
struct Showing {
  double first_stamp = 0.0;  ///< [s] on the recording's clock, where the replays' time is 0
  std::vector<Replay> replays;
  std::vector<Picture> pictures;
};

}  // namespace tissue_stiffness
