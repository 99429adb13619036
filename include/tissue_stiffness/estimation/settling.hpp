#pragma once

#include <Eigen/Core>
#include <deque>

namespace tissue_stiffness {

/// Whether an estimate has settled: it lies within the 95 % intervals that were published over the last third of the
/// frames, eight at least.
class Settling {
 public:
  /// Mean and standard deviations after a frame, filter coordinates.
  void add(const Eigen::VectorXd& mean, const Eigen::VectorXd& std);
  bool settled() const;

 private:
  struct Published {
    Eigen::VectorXd mean, std;
  };
  std::size_t frames_ = 0;
  std::deque<Published> published_;  ///< the last ones, oldest first
};

}  // namespace tissue_stiffness
