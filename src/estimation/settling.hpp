#pragma once

#include <Eigen/Core>
#include <deque>

namespace tissue_stiffness {

/// An estimate has settled when it lies within the 95 % intervals that were published over the last third of the frames.
/// These are eight frames at least.
class Settling {
 public:
  /// Takes mean and standard deviations after a frame, in filter coordinates.
  void add(const Eigen::VectorXd& mean, const Eigen::VectorXd& std);
  bool settled() const;

 private:
  struct Published {
    Eigen::VectorXd mean, std;
  };
  std::size_t frames_ = 0;
  std::deque<Published> published_;  ///< the latest ones, oldest first
};

}  // namespace tissue_stiffness
