#pragma once

#include <string>
#include <vector>

#include "effects/course.hpp"
#include "effects/terms.hpp"
#include "tissue_stiffness/types/load_sample.hpp"

namespace tissue_stiffness {

/// The loads that a model's effects ask for, and what was measured of them.
class Loads {
 public:
  const std::vector<LoadInput>& inputs() const { return inputs_; }
  CourseTable& courses() { return courses_; }
  const CourseTable& courses() const { return courses_; }
  std::vector<LoadInput>& inputs() { return inputs_; }

  /// Sets the time of the recording's first stamp [s]. Courses from files and rhythms count from it. It is 0 until it is
  /// set.
  void set_first_stamp(double time);
  /// Sets when the body was at rest, after the first stamp [s].
  void set_rest(double after_first_stamp) { rest_ = after_first_stamp; }
  double first_stamp() const { return first_stamp_; }
  /// Sets the first stamp and adds the loads of a whole recording. Loads of topics that the model does not use are skipped.
  void drive(double first_stamp, const std::vector<LoadSample>& samples);

  /// Returns which load is silent at a time, as a sentence; empty: none. The model holds a load that falls silent, and the
  /// motion meanwhile says nothing of the body (see Course::silence).
  std::string silence(double time) const;

  /// Returns the value of a load term at a time: measured, from a rhythm, or 1. A measured load includes `factor`, and a
  /// prescribed motion does not.
  double value(const LoadTerm& term, const Parameters& parameters, double factor, double time) const;

 private:
  CourseTable courses_;
  std::vector<LoadInput> inputs_;
  double first_stamp_ = 0.0, rest_ = 0.0;
};

}  // namespace tissue_stiffness
