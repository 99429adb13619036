#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "fit/free_run.hpp"
#include "types/replay.hpp"

namespace tissue_stiffness {

/// A thin surface is a mesh's surface with at most so many vertices: nodes that share a cell of a grid become one.
struct ThinSurface {
  ThinSurface(const TetMesh& mesh, std::size_t most_vertices);

  std::vector<std::vector<int>> members;  ///< mesh nodes of each vertex
  Eigen::Matrix3Xi triangles;             ///< of vertices, none degenerate

  /// Returns a nodal field's (3n) mean over each vertex's members.
  Eigen::Matrix3Xd mean(const Eigen::VectorXd& field) const;
  /// Returns the root mean square over each vertex's members that have a number; NaN without one.
  Eigen::VectorXd rms(const Eigen::VectorXd& values) const;
};

/// The recorder makes a Replay of a free run while it goes, in bounded memory: it keeps every second, fourth, ... frame of
/// a long run.
class ReplayRecorder {
 public:
  /// `first_stamp` is the replay's time 0 [s]. Outlines are kept only at `picture_stamps` [s].
  ReplayRecorder(const TetMesh& mesh, double first_stamp, const std::vector<double>& picture_stamps);

  void add(const FreeFrame& frame);
  /// It is called once, after the last frame.
  Replay finish();

 private:
  using Key = std::pair<int, int>;  ///< source, then vertex or marker; -1 stands for the whole observation
  struct Seen {
    Eigen::VectorXd measured, predicted;
  };

  void add_tracks(const FreeFrame& frame);
  void add_named(const Observation& observation, const Prediction& p, Eigen::Index from);
  void add_outline(const Observation& observation, const FreeFrame& frame);
  void add_surface(const FreeFrame& frame);
  ReplayTrack track(const Key& key, ObservationKind kind) const;

  ThinSurface thin_;
  double first_stamp_;
  std::set<double> picture_stamps_;
  std::size_t most_surfaces_;
  std::size_t count_ = 0, stride_ = 1, surface_stride_ = 1;
  Replay replay_;
  std::vector<std::map<Key, Seen>> seen_;  ///< one for each kept frame
  std::map<Key, ObservationKind> kinds_;
};

}  // namespace tissue_stiffness
