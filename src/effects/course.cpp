#include "tissue_stiffness/effects/course.hpp"

#include <algorithm>
#include <fstream>
#include <mutex>
#include <sstream>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

Course Course::from_csv(const std::string& file, int components) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file, "no readable file", "a CSV file with rows of time [s] and value(s)");
  Course course(components);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    double time = 0.0;
    if (!(row >> time)) {
      if (number == 1 || line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
      throw InputError(file + ":" + std::to_string(number), "'" + line + "'", "time [s] and value(s), numbers");
    }
    Eigen::VectorXd value(components);
    for (int i = 0; i < components; ++i) {
      if (!(row >> value[i])) {
        throw InputError(file + ":" + std::to_string(number), "'" + line + "'",
                         "time [s] and " + std::to_string(components) + " value(s)");
      }
    }
    course.add(time, value);
  }
  if (course.empty()) throw InputError(file, "no rows", "at least one row of time [s] and value(s)");
  course.from_file_ = true;
  return course;
}

Course::Course(const Course& other) {
  *this = other;
}

Course& Course::operator=(const Course& other) {
  if (this == &other) return *this;
  const std::shared_lock<std::shared_mutex> theirs(other.mutex_);
  const std::unique_lock<std::shared_mutex> own(mutex_);
  components_ = other.components_;
  from_file_ = other.from_file_;
  offset_ = other.offset_;
  times_ = other.times_;
  values_ = other.values_;
  return *this;
}

bool Course::empty() const {
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  return times_.empty();
}

void Course::add(double time, const Eigen::VectorXd& value) {
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  const auto at = std::lower_bound(times_.begin(), times_.end(), time);
  const auto index = at - times_.begin();
  if (at != times_.end() && *at == time) {
    values_[static_cast<std::size_t>(index)] = value;
    return;
  }
  times_.insert(at, time);
  values_.insert(values_.begin() + index, value);
}

double Course::value(double time, int component) const {
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  if (times_.empty()) return 0.0;
  time -= offset_;
  const auto at = std::upper_bound(times_.begin(), times_.end(), time);
  if (at == times_.begin()) return values_.front()[component];
  if (at == times_.end()) return values_.back()[component];
  const auto i = static_cast<std::size_t>(at - times_.begin());
  const double s = (time - times_[i - 1]) / (times_[i] - times_[i - 1]);
  return (1.0 - s) * values_[i - 1][component] + s * values_[i][component];
}

void Course::clear() {
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  if (from_file_) return;
  times_.clear();
  values_.clear();
}

void Course::shift(double offset) {
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  if (from_file_) offset_ = offset;
}

}  // namespace tissue_stiffness
