#include "effects/course.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "tissue_stiffness/types/error.hpp"
#include "types/median.hpp"
#include "types/read_pose.hpp"
#include "types/read_table.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::ptrdiff_t kFewest = 3, kMost = 31;  // intervals whose median is the load's
constexpr double kPauses = 5.0;                    // intervals; a shorter pause is no silence

}  // namespace

Course Course::from_csv(const std::string& file, LoadInput::Kind kind) {
  Course course(kind);
  const bool poses = kind == LoadInput::Kind::pose;
  const auto columns = static_cast<Eigen::Index>(poses ? 7 : course.components());
  const std::string what = "time [s] and " + std::to_string(columns) + " value(s)";
  for (const TableRow& row : read_table(file, static_cast<std::size_t>(columns) + 1, what)) {
    const Eigen::VectorXd value = Eigen::Map<const Eigen::VectorXd>(row.numbers.data() + 1, columns);
    course.add(row.numbers[0], poses ? read_pose(value, row.where) : value);
  }
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
  kind_ = other.kind_;
  components_ = other.components_;
  from_file_ = other.from_file_;
  torque_ = other.torque_;
  offset_ = other.offset_;
  path_ = other.path_;
  times_ = other.times_;
  values_ = other.values_;
  corrected_ = other.corrected_;
  basis_ = other.basis_;
  coefficients_ = other.coefficients_;
  tolerance_ = other.tolerance_;
  return *this;
}

bool Course::empty() const {
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  return times_.empty();
}

std::optional<double> Course::last() const {
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  if (times_.empty()) return std::nullopt;
  return times_.back() + offset_;
}

std::optional<Course::Silence> Course::silence(double time) const {
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  const auto next = std::upper_bound(times_.begin(), times_.end(), time - offset_);
  const std::ptrdiff_t before = next - times_.begin();
  if (from_file_ || before <= kFewest) return std::nullopt;
  std::vector<double> intervals;
  for (auto sample = next - 1; sample != next - 1 - std::min(before - 1, kMost); --sample) {
    intervals.push_back(*sample - *(sample - 1));
  }
  const Silence out{time - offset_ - *(next - 1), median_of(std::move(intervals))};
  return out.since > kPauses * out.interval ? std::optional(out) : std::nullopt;
}

void Course::add(double time, const Eigen::VectorXd& value) {
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  const auto at = std::lower_bound(times_.begin(), times_.end(), time);
  const auto index = static_cast<std::size_t>(at - times_.begin());
  if (at != times_.end() && *at == time) {
    values_[index] = value;
  } else {
    times_.insert(at, time);
    values_.insert(values_.begin() + static_cast<std::ptrdiff_t>(index), value);
    if (!corrected_.empty()) corrected_.insert(corrected_.begin() + static_cast<std::ptrdiff_t>(index), value);
  }
  if (kind_ == LoadInput::Kind::pose) path_.add(time, value);
  if (!corrected_.empty()) correct_sample(index);
}

double Course::interpolated(const std::vector<Eigen::VectorXd>& values, double time, int component) const {
  if (times_.empty()) return 0.0;
  time -= offset_;
  const auto at = std::upper_bound(times_.begin(), times_.end(), time);
  if (at == times_.begin()) return values.front()[component];
  if (at == times_.end()) return values.back()[component];
  const auto i = static_cast<std::size_t>(at - times_.begin());
  const double s = (time - times_[i - 1]) / (times_[i] - times_[i - 1]);
  return (1.0 - s) * values[i - 1][component] + s * values[i][component];
}

// Returns a component of the load, or of the motion since rest where the values are poses. The caller must hold the lock.
double Course::uncorrected(double time, int component) const {
  return kind_ == LoadInput::Kind::pose ? path_.motion(time - offset_, component) : interpolated(values_, time, component);
}

double Course::value(double time, int component) const {
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  if (corrected_.empty()) return uncorrected(time, component);
  if (kind_ != LoadInput::Kind::pose) return interpolated(corrected_, time, component);
  return path_.motion(time - offset_, component) - correction(time, component);
}

// The caller must hold the lock.
double Course::correction(double time, int component) const {
  return interpolated(values_, time, component) - interpolated(corrected_, time, component);
}

std::optional<Eigen::Matrix<double, 3, 4>> Course::pose(double time) const {
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  if (path_.empty()) return std::nullopt;
  Eigen::Matrix<double, 3, 4> out = path_.pose(time - offset_);
  for (int i = 0; i < 3 && !corrected_.empty(); ++i) out(i, 3) -= correction(time, i);
  return out;
}

double Course::measured(double time, int component) const {
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  return uncorrected(time, component);
}

// The caller must hold the lock.
void Course::correct_sample(std::size_t index) {
  const auto measured = [this](double time) {
    Eigen::VectorXd out(acting());
    for (int i = 0; i < out.size(); ++i) out[i] = uncorrected(time, i);
    return out;
  };
  corrected_[index] = values_[index];
  corrected_[index].head(acting()) -= basis_.value(measured, times_[index] + offset_) * coefficients_;
}

void Course::correct(const LoadErrorBasis& basis, const Eigen::VectorXd& coefficients) {
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  basis_ = basis;
  coefficients_ = coefficients;
  corrected_.clear();
  if (coefficients.size() == 0) return;
  corrected_ = values_;
  for (std::size_t i = 0; i < values_.size(); ++i) correct_sample(i);
}

void Course::clear() {
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  coefficients_.resize(0);
  corrected_.clear();
  if (from_file_) return;
  times_.clear();
  values_.clear();
  path_.clear();
}

void Course::start(double first_stamp, double at_rest) {
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  if (from_file_) offset_ = first_stamp;
  path_.set_rest(at_rest - offset_);
}

void Course::set_smoothing(double half_width) {
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  path_.set_smoothing(half_width);
}

}  // namespace tissue_stiffness
