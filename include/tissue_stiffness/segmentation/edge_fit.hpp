#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace tissue_stiffness {

/// A blurred step in a grey-value profile.
struct EdgeFit {
  double offset = 0.0;    ///< where the step is, along the profile, from its middle [pixel]
  double step = 0.0;      ///< grey value just inside minus just outside
  double residual = 0.0;  ///< sum of squares that the model leaves
  double gain = 0.0;      ///< information on `offset` per unit noise variance: sigma = noise / sqrt(gain)
  bool at_end = false;    ///< best at the end of the searched range: no step found
};

/// Least-squares fit of a blurred step to profiles sampled once a pixel from inside (t < 0) to outside (t > 0):
///   I(t) = (a + b (t-d)) Phi((d-t)/blur) + (c + e (t-d)) (1 - Phi((d-t)/blur)),
/// Phi the normal distribution: both sides may be shaded linearly, so that limb darkening and soft shadows do not move d
/// the way they move a 50 % crossing. a, b, c, e are linear and eliminated for every d of a grid (variable projection,
/// Golub & Pereyra 1973); the minimum over d is refined by a parabola. gain is the Fisher information of d.
class StepEdge {
 public:
  /// `blur`: Gaussian sigma of the imaging blur; `reach`: half length of a profile; `search`: largest |d| [pixel].
  StepEdge(double blur, int reach, double search);

  /// One fit for each column of `profiles`.
  std::vector<EdgeFit> fit(const Eigen::MatrixXd& profiles) const;
  double blur() const { return blur_; }
  int degrees_of_freedom() const { return static_cast<int>(times_.size()) - 5; }

 private:
  double blur_;
  Eigen::VectorXd times_;
  Eigen::VectorXd offsets_;  ///< the grid of d
  Eigen::MatrixXd bases_;    ///< 4 rows for each d: orthonormal basis of the linear terms
  Eigen::MatrixXd steps_;    ///< a row for each d: profile -> a - c
  Eigen::VectorXd gains_;    ///< for each d: squared norm of dI/dd for a unit step, the linear terms projected out
};

/// Grey values along the normal at t = -reach ... reach, averaged over three parallel lines one pixel apart.
Eigen::VectorXd normal_profile(const cv::Mat& grey, const Eigen::Vector2d& point, const Eigen::Vector2d& normal, int reach);

}  // namespace tissue_stiffness
