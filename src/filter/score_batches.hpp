#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// Actual variance of a fit's gradient, whatever correlates its errors, by batch means. The frames are summed in a few
/// batches of equal length, which grows with the recording. Errors of sensor and model that last as long as a batch cause a
/// spread between batches that is larger than the noise explains (Carlstein 1986). The resulting covariance is the sandwich
/// of Huber 1967 and White 1982.
class ScoreBatches {
 public:
  /// Adds a frame's part of the information and of the gradient, H^T R^-1 H and H^T R^-1 e at the anchor.
  void add(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient);
  void clear() { *this = ScoreBatches(); }

  /// Returns the number of full batches, at most 31. Fewer than 16 have no effect.
  int count() const { return static_cast<int>(batches_.size()); }
  /// Returns the variance of the whole gradient, p x p, at `step` from the anchor.
  Eigen::MatrixXd variance(const Eigen::VectorXd& step) const;

  /// Returns `covariance` (the inverse of the information, p x p), widened to what `variance` implies. This is done in
  /// those directions in which `variance` is larger than the number of batches explains by chance.
  Eigen::MatrixXd widened(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& variance) const;

 private:
  struct Batch {
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
    int frames = 0;
  };
  std::vector<Batch> batches_;
  Batch open_;
  int length_ = 1;  ///< frames in each batch
};

}  // namespace tissue_stiffness
