#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// A load's value over time: linear between samples, held outside, zero before the first sample arrives.
class Course {
 public:
  explicit Course(int components) : components_(components) {}

  /// Reads `time,value...` rows (s and SI units; a header line and # comments are skipped). Times count from the
  /// recording's first stamp. Throws InputError naming file and line.
  static Course from_csv(const std::string& file, int components);

  /// Samples may come late, but not twice at one time: the later value wins.
  void add(double time, const Eigen::VectorXd& value);
  double value(double time, int component) const;
  void clear();
  bool empty() const { return times_.empty(); }
  int components() const { return components_; }
  double last_time() const { return times_.back(); }
  /// Offset added to the times of a file's samples when the recording's first stamp is known.
  void shift(double offset);
  bool from_file() const { return from_file_; }

 private:
  int components_;
  bool from_file_ = false;
  double offset_ = 0.0;
  std::vector<double> times_;
  std::vector<Eigen::VectorXd> values_;
};

/// Courses by topic, shared by effects that listen to the same one.
using CourseTable = std::map<std::string, std::shared_ptr<Course>>;

}  // namespace tissue_stiffness
