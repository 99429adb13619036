#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <initializer_list>
#include <vector>

namespace tissue_stiffness {

/// This tells where the rows of each frame are in a vector that holds one frame after the other.
class FrameRows {
 public:
  struct Range {
    Eigen::Index from = 0, size = 0;
    Eigen::Index end() const { return from + size; }
  };

  FrameRows() = default;
  FrameRows(std::initializer_list<Eigen::Index> sizes) {
    for (const Eigen::Index size : sizes) append(size);
  }

  /// Appends a frame of so many rows.
  void append(Eigen::Index size) { ends_.push_back(total() + size); }
  /// Returns the number of frames.
  Eigen::Index count() const { return static_cast<Eigen::Index>(ends_.size()); }
  /// Returns the number of rows of all frames.
  Eigen::Index total() const { return before(count()); }
  /// Returns the number of rows before a frame, which may be the one after the last.
  Eigen::Index before(Eigen::Index frame) const { return frame == 0 ? 0 : ends_[static_cast<std::size_t>(frame) - 1]; }
  Range operator[](Eigen::Index frame) const { return {before(frame), before(frame + 1) - before(frame)}; }

 private:
  std::vector<Eigen::Index> ends_;
};

}  // namespace tissue_stiffness
