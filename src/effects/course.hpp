#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "effects/load_error.hpp"
#include "effects/motion_path.hpp"
#include "tissue_stiffness/types/load_sample.hpp"

namespace tissue_stiffness {

/// A load's value over time. It is linear between samples, constant outside them, and zero before the first sample arrives.
/// It is thread safe: samples may arrive while runs of the past read values.
///
/// The course of a pose takes poses (see pose_values) and gives the motion since the body was at rest (see MotionPath).
class Course {
 public:
  explicit Course(LoadInput::Kind kind) : kind_(kind), components_(component_count(kind)) {}
  Course(const Course& other);
  Course& operator=(const Course& other);

  /// Reads `time,value...` rows (s and SI units); a header line and # comments are skipped. Times count from the
  /// recording's first stamp. A pose has seven values: position and quaternion (x, y, z, w). Throws InputError naming file
  /// and line.
  static Course from_csv(const std::string& file, LoadInput::Kind kind);

  /// Adds a sample, which may come late. There is only one for each time: a later value replaces an earlier one.
  void add(double time, const Eigen::VectorXd& value);
  /// Returns the value, corrected if there is a correction.
  double value(double time, int component) const;
  /// Returns the pose [R | c] of a course of poses, corrected like its value; empty before the first one.
  std::optional<Eigen::Matrix<double, 3, 4>> pose(double time) const;
  /// Returns the value as it was measured.
  double measured(double time, int component) const;
  /// Subtracts the error that `basis` and its coefficients describe from every sample, including future ones. The estimated
  /// load is measured - B(t) coefficients. Without coefficients the load is as measured.
  void correct(const LoadErrorBasis& basis, const Eigen::VectorXd& coefficients);
  /// Returns the number of components that act, whose errors are estimated: 1 of a pressure, 3 of a wrench whose torque
  /// does not act and of a pose, and 6 of a wrench whose torque does.
  int acting() const { return torque_ ? components_ : std::min(components_, 3); }
  /// Lets the torque of a wrench act.
  void use_torque() { torque_ = true; }
  const LoadTolerance& tolerance() const { return tolerance_; }
  void set_tolerance(const LoadTolerance& tolerance) { tolerance_ = tolerance; }
  /// Returns the time of the last sample [s]; empty before the first.
  std::optional<double> last() const;
  /// How long ago the last sample was, and how far apart samples are then: the median of the last intervals [s].
  struct Silence {
    double since, interval;
  };
  /// Returns the silence at a time: the last sample until then is older than five intervals. There is none before the
  /// first sample, while fewer than three intervals are known, and of a course from a file.
  std::optional<Silence> silence(double time) const;
  void clear();
  bool empty() const;
  int components() const { return components_; }
  LoadInput::Kind kind() const { return kind_; }
  /// Tells the recording's first stamp, from which the times of a file's samples count, and when the body was at rest [s].
  void start(double first_stamp, double at_rest);
  bool from_file() const { return from_file_; }
  /// Sets how a motion is smoothed, see MotionPath.
  void set_smoothing(double half_width);

 private:
  double interpolated(const std::vector<Eigen::VectorXd>& values, double time, int component) const;
  double uncorrected(double time, int component) const;
  double correction(double time, int component) const;
  void correct_sample(std::size_t index);

  LoadTolerance tolerance_;
  mutable std::shared_mutex mutex_;  ///< protects everything below
  LoadInput::Kind kind_;
  int components_;
  bool from_file_ = false, torque_ = false;
  double offset_ = 0.0;
  std::vector<double> times_;
  std::vector<Eigen::VectorXd> values_;     ///< as measured
  std::vector<Eigen::VectorXd> corrected_;  ///< empty: no correction
  MotionPath path_;                         ///< of a pose
  LoadErrorBasis basis_;
  Eigen::VectorXd coefficients_;
};

/// Courses by topic. Effects that use the same topic share its course.
using CourseTable = std::map<std::string, std::shared_ptr<Course>>;

}  // namespace tissue_stiffness
