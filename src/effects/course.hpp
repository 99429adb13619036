#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "effects/load_error.hpp"

namespace tissue_stiffness {

/// A load's value over time. It is linear between samples, constant outside them, and zero before the first sample arrives.
/// It is thread safe: samples may arrive while runs of the past read values.
class Course {
 public:
  explicit Course(int components) : components_(components) {}
  Course(const Course& other);
  Course& operator=(const Course& other);

  /// Reads `time,value...` rows (s and SI units); a header line and # comments are skipped. Times count from the
  /// recording's first stamp. Throws InputError naming file and line.
  static Course from_csv(const std::string& file, int components);

  /// Adds a sample, which may come late. There is only one for each time: a later value replaces an earlier one.
  void add(double time, const Eigen::VectorXd& value);
  /// Returns the value, corrected if there is a correction.
  double value(double time, int component) const;
  /// Returns the value as it was measured.
  double measured(double time, int component) const;
  /// Subtracts the error that `basis` and its coefficients describe from every sample, including future ones. The estimated
  /// load is measured - B(t) coefficients. Without coefficients the load is as measured.
  void correct(const LoadErrorBasis& basis, const Eigen::VectorXd& coefficients);
  /// Returns the number of components that act: 3 of a wrench, 1 of a pressure.
  int acting() const { return components_ < 3 ? components_ : 3; }
  const LoadTolerance& tolerance() const { return tolerance_; }
  void set_tolerance(const LoadTolerance& tolerance) { tolerance_ = tolerance; }
  /// Returns the time of the last sample [s]; empty before the first.
  std::optional<double> last() const;
  void clear();
  bool empty() const;
  int components() const { return components_; }
  /// Sets the offset that is added to the times of a file's samples when the recording's first stamp is known.
  void shift(double offset);
  bool from_file() const { return from_file_; }

 private:
  double interpolated(const std::vector<Eigen::VectorXd>& values, double time, int component) const;
  void correct_sample(std::size_t index);

  LoadTolerance tolerance_;
  mutable std::shared_mutex mutex_;  ///< protects everything below
  int components_;
  bool from_file_ = false;
  double offset_ = 0.0;
  std::vector<double> times_;
  std::vector<Eigen::VectorXd> values_;     ///< as measured
  std::vector<Eigen::VectorXd> corrected_;  ///< empty: no correction
  LoadErrorBasis basis_;
  Eigen::VectorXd coefficients_;
};

/// Courses by topic. Effects that use the same topic share its course.
using CourseTable = std::map<std::string, std::shared_ptr<Course>>;

}  // namespace tissue_stiffness
