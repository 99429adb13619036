#pragma once

#include <Eigen/Core>
#include <deque>

namespace tissue_stiffness {

/// Whether an estimate has settled: over the last third of the frames, eight at least, it stayed within one standard
/// deviation of where it is now.
class Settling {
 public:
  /// Mean and standard deviations after a frame, filter coordinates.
  void add(const Eigen::VectorXd& mean, const Eigen::VectorXd& std);
  bool settled() const;

 private:
  std::size_t frames_ = 0;
  std::deque<Eigen::VectorXd> means_;  ///< the last ones, oldest first
  Eigen::VectorXd std_;
};

}  // namespace tissue_stiffness
