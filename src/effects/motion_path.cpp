#include "effects/motion_path.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kFewest = 2;  // neighbours to either side
constexpr Eigen::Index kValues = 12;

}  // namespace

void MotionPath::set_smoothing(double half_width) {
  half_width_ = half_width;
  for (std::size_t k = 0; k < knots_.size(); ++k) fit(k);
  find_rest();
}

void MotionPath::set_rest(double time) {
  rest_ = time;
  find_rest();
}

void MotionPath::add(double time, const Eigen::VectorXd& pose) {
  const auto before = [](const Knot& knot, double t) { return knot.time < t; };
  auto place = std::lower_bound(knots_.begin(), knots_.end(), time, before);
  if (place == knots_.end() || place->time != time) place = knots_.insert(place, {time, pose, pose, {}});
  place->measured = pose;
  const auto index = static_cast<std::size_t>(place - knots_.begin());
  const auto reached = [&](std::size_t k) {
    const std::size_t apart = k > index ? k - index : index - k;
    return apart <= 2 * kFewest || std::abs(knots_[k].time - time) <= 2.0 * half_width_;
  };
  for (std::size_t k = index + 1; k > 0 && reached(k - 1); --k) fit(k - 1);
  for (std::size_t k = index + 1; k < knots_.size() && reached(k); ++k) fit(k);
  find_rest();
}

// Returns the first neighbour and the one behind the last. What an end lacks on one side it has more on the other.
std::pair<std::size_t, std::size_t> MotionPath::neighbours(std::size_t index) const {
  const double time = knots_[index].time;
  const double before = std::min(half_width_, time - knots_.front().time),
               after = std::min(half_width_, knots_.back().time - time);
  const std::size_t behind = knots_.size() - 1 - index;
  const std::size_t fewest_before = std::min(index, 2 * kFewest - std::min(kFewest, behind)),
                    fewest_after = std::min(behind, 2 * kFewest - std::min(kFewest, index));
  std::size_t first = index, end = index + 1;
  while (first > 0 && (index - first < fewest_before || time - knots_[first - 1].time <= 2.0 * half_width_ - after))
    --first;
  while (end < knots_.size() && (end - index <= fewest_after || knots_[end].time - time <= 2.0 * half_width_ - before))
    ++end;
  return {first, end};
}

void MotionPath::fit(std::size_t index) {
  Knot& knot = knots_[index];
  knot.value = knot.measured;
  if (half_width_ == 0.0) return;
  const auto [first, end] = neighbours(index);
  const auto count = static_cast<Eigen::Index>(end - first), terms = std::min<Eigen::Index>(count, 3);
  const double span = std::max(knots_[end - 1].time - knots_[first].time, 1e-9);
  Eigen::MatrixXd powers(count, terms), values(count, kValues);
  for (Eigen::Index row = 0; row < count; ++row) {
    const Knot& other = knots_[first + static_cast<std::size_t>(row)];
    for (Eigen::Index p = 0; p < terms; ++p) powers(row, p) = std::pow((other.time - knot.time) / span, p);
    values.row(row) = other.measured.transpose();
  }
  const Eigen::MatrixXd fitted = powers.householderQr().solve(values);
  knot.value = fitted.row(0).transpose();
  knot.slope = terms > 1 ? Eigen::VectorXd(fitted.row(1).transpose() / span) : Eigen::VectorXd::Zero(kValues);
}

double MotionPath::at(double time, int component) const {
  const auto after = [](double t, const Knot& knot) { return t < knot.time; };
  const auto next = std::upper_bound(knots_.begin(), knots_.end(), time, after);
  if (next == knots_.begin()) return knots_.front().value[component];
  if (next == knots_.end()) return knots_.back().value[component];
  const Knot &a = *(next - 1), &b = *next;
  const double span = b.time - a.time, s = (time - a.time) / span;
  const double from = a.value[component], to = b.value[component];
  if (half_width_ == 0.0) return (1.0 - s) * from + s * to;
  const double up = s * s * (3.0 - 2.0 * s);  // from 0 to 1
  return from + (to - from) * up + span * s * (1.0 - s) * ((1.0 - s) * a.slope[component] - s * b.slope[component]);
}

Eigen::Matrix<double, 3, 4> MotionPath::pose(double time) const {
  Eigen::Matrix<double, 3, 4> out;
  for (int i = 0; i < 9; ++i) out(i % 3, i / 3) = at(time, 3 + i);
  for (int i = 0; i < 3; ++i) out(i, 3) = at(time, i);
  return out;
}

void MotionPath::find_rest() {
  if (knots_.empty()) return;
  const Eigen::Matrix<double, 3, 4> rest = pose(rest_);
  from_rest_rotation_ = rest.leftCols<3>().inverse();
  rest_position_ = rest.col(3);
}

// A component needs one row of R(t) only.
double MotionPath::motion(double time, int component) const {
  if (knots_.empty()) return 0.0;
  const int axis = component % 3;
  const Eigen::RowVector3d row(at(time, 3 + axis), at(time, 6 + axis), at(time, 9 + axis));
  const Eigen::RowVector3d since_rest = row * from_rest_rotation_;
  if (component < 3) return at(time, component) - since_rest.dot(rest_position_);
  const int column = component / 3 - 1;
  return since_rest[column] - (column == axis ? 1.0 : 0.0);
}

}  // namespace tissue_stiffness
