#pragma once

#include <Eigen/Core>
#include <vector>

namespace tissue_stiffness {

/// How much the gradient of a fit really varies, whatever correlates its errors: batch means. The frames are summed in a
/// few batches of equal length, which grow with the recording; what sensor and model do wrong for as long as a batch
/// lasts shows as a spread between batches that is larger than the noise explains (Carlstein 1986; the covariance that
/// follows is the sandwich of Huber 1967 and White 1982).
class ScoreBatches {
 public:
  /// A frame's share of the information and of the gradient, H^T R^-1 H and H^T R^-1 e at the anchor.
  void add(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient);
  void clear() { *this = ScoreBatches(); }

  /// Full batches: none, or 16 to 31.
  int count() const { return static_cast<int>(batches_.size()); }
  /// Variance of the whole gradient, p x p, at `step` from the anchor.
  Eigen::MatrixXd variance(const Eigen::VectorXd& step) const;

  /// `covariance` (the inverse of the information, p x p) made as wide as `variance` has it, in those directions in which
  /// that is larger by more than the batches' number leaves to chance.
  Eigen::MatrixXd widened(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& variance) const;

 private:
  struct Batch {
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
    int frames = 0;
  };
  std::vector<Batch> batches_;
  Batch open_;
  int length_ = 1;  ///< frames a batch
};

}  // namespace tissue_stiffness
