#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// The path of a rigid body through measured poses, and its motion since rest, x = X + d + A X:
///   R = R(t) R(rest)^-1, A = R - I, d = c(t) - R c(rest).
/// A hand or an arm moves smoothly, and the noise of its pose does not. Differences of noisy poses would be accelerations
/// that nothing has. So each pose is replaced by the local quadratic through its neighbours, by least squares (Savitzky &
/// Golay 1964). What an end lacks on one side it has more on the other. In between the path is the cubic with the values
/// and slopes of both ends (Hermite).
class MotionPath {
 public:
  static constexpr double usual_smoothing = 0.04;  ///< [s]

  /// Sets the half width of the neighbourhood [s], which holds at least two poses to either side; 0: the poses are taken as
  /// measured, and the path is straight between them.
  void set_smoothing(double half_width);
  /// Sets when the body was at rest [s].
  void set_rest(double time);
  /// Adds a pose (see pose_values), which may come late. A later one of the same time replaces an earlier one.
  void add(double time, const Eigen::VectorXd& pose);
  void clear() { knots_.clear(); }

  /// Returns a component of the motion: d [m], then the columns of A. It is held before the first pose and after the last,
  /// and 0 without any.
  double motion(double time, int component) const;
  /// Returns the pose itself: [R | c], 3 x 4 [-, m]. It is held like the motion. There must be one.
  Eigen::Matrix<double, 3, 4> pose(double time) const;
  bool empty() const { return knots_.empty(); }

 private:
  struct Knot {
    double time;
    Eigen::VectorXd measured, value, slope;
  };
  double at(double time, int component) const;
  std::pair<std::size_t, std::size_t> neighbours(std::size_t knot) const;
  void fit(std::size_t knot);
  void find_rest();

  double half_width_ = usual_smoothing, rest_ = 0.0;
  std::vector<Knot> knots_;
  Eigen::Vector3d rest_position_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d from_rest_rotation_ = Eigen::Matrix3d::Identity();  ///< R(rest)^-1
};

}  // namespace tissue_stiffness
