#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace tissue_stiffness {

/// A blurred step that was fitted to a grey-value profile.
struct EdgeFit {
  double offset = 0.0;    ///< position of the step along the profile, from its middle [pixel]
  double step = 0.0;      ///< grey value just inside the step minus that just outside
  double residual = 0.0;  ///< sum of squares of the fit's residual
  double gain = 0.0;      ///< information on `offset` per unit noise variance: sigma = noise / sqrt(gain)
  bool at_end = false;    ///< true: the best fit is at the end of the searched range, so no step was found
};

/// Fits a blurred step by least squares to profiles that are sampled once a pixel, from inside (t < 0) to outside (t > 0).
/// The model is
///   I(t) = (a + b (t-d)) Phi((d-t)/blur) + (c + e (t-d)) (1 - Phi((d-t)/blur)),
/// where Phi is the normal distribution. Both sides may be shaded linearly, so that limb darkening and soft shadows do not
/// move d as they move a 50 % crossing. The linear coefficients a, b, c, e are eliminated for every d of a grid (variable
/// projection, Golub & Pereyra 1973). The minimum over d is refined by a parabola. gain is the Fisher information of d.
class StepEdge {
 public:
  /// `blur`: Gaussian sigma of the imaging blur; `reach`: half length of a profile; `search`: largest |d| [pixel].
  StepEdge(double blur, int reach, double search);

  /// Returns one fit for each column of `profiles`.
  std::vector<EdgeFit> fit(const Eigen::MatrixXd& profiles) const;
  double blur() const { return blur_; }
  int degrees_of_freedom() const { return static_cast<int>(times_.size()) - 5; }

 private:
  double blur_;
  Eigen::VectorXd times_;
  Eigen::VectorXd offsets_;  ///< grid of d [pixel]
  Eigen::MatrixXd bases_;    ///< 4 rows for each d: orthonormal basis of the linear terms
  Eigen::MatrixXd steps_;    ///< a row for each d that maps a profile to a - c
  Eigen::VectorXd gains_;    ///< for each d: squared norm of dI/dd for a unit step, with the linear terms projected out
};

/// Samples grey values along the normal at t = -reach ... reach, averaged over three parallel lines one pixel apart.
Eigen::VectorXd normal_profile(const cv::Mat& grey, const Eigen::Vector2d& point, const Eigen::Vector2d& normal, int reach);

}  // namespace tissue_stiffness
