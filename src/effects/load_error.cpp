#include "effects/load_error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tissue_stiffness {
namespace {

constexpr double kKnotsPerTime = 12.0;  // of the noise, a correlation time: 3 % of its variance is faster
constexpr int kMostKnots = 120;         // of the noise: longer recordings have them further apart
constexpr int kSamples = 200;           // of a load, to find its size and its rate
constexpr double kRateSpan = 0.02;      // [s] over which a rate of change is read
constexpr double kTurning = 0.1;        // of the rms rate: below it the hysteresis changes its sign gradually

Eigen::VectorXd rate(const LoadErrorBasis::Load& load, double time) {
  return (load(time + kRateSpan) - load(time - kRateSpan)) / (2.0 * kRateSpan);
}

double correlation(const LoadTolerance& noise, double lag) {
  const double r = std::sqrt(3.0) * lag / noise.correlation_time;
  return noise.smooth ? (1.0 + r) * std::exp(-r) : std::exp(-lag / noise.correlation_time);
}

std::string name_of(LoadErrorBasis::Error error) {
  switch (error) {
    case LoadErrorBasis::Error::gain:
      return "gain";
    case LoadErrorBasis::Error::bias:
      return "bias";
    case LoadErrorBasis::Error::delay:
      return "delay";
    case LoadErrorBasis::Error::hysteresis:
      return "hysteresis";
    case LoadErrorBasis::Error::direction:
      return "direction";
    case LoadErrorBasis::Error::noise:
      return "noise";
  }
  return "";
}

}  // namespace

bool LoadTolerance::exact() const {
  for (const double std : {gain, bias, noise, delay, hysteresis, direction, torque_bias, torque_noise, torque_hysteresis}) {
    if (std != 0.0) return false;
  }
  return true;
}

std::vector<std::pair<std::string, std::string>> load_error_keys(const std::string& unit, bool has_direction) {
  const std::string absolute = " [" + unit + "], 1 sigma; ";
  std::vector<std::pair<std::string, std::string>> keys{
      {"gain", "relative error of the sensor's scale, 1 sigma; 0.1 when absent, 0 when `scale` is estimated"},
      {"bias", "constant offset of each component" + absolute + "10 % of the largest load when absent"},
      {"noise", "slow noise of each component" + absolute + "2 % of the largest load when absent"},
      {"correlation_time", "of the slow noise [s]; 0.5 when absent"},
      {"delay", "how late the load is stamped [s], 1 sigma; 0.01 when absent"},
      {"hysteresis",
       "offset along the sign of the load's rate of change" + absolute + "3 % of the largest load when absent"}};
  if (has_direction)
    keys.emplace_back("direction", "rotation of the sensor about each axis [rad], 1 sigma; 0.05 when absent");
  return keys;
}

std::vector<std::pair<std::string, std::string>> torque_error_keys() {
  const std::string absolute = " of the torque [N m], 1 sigma; ";
  return {{"torque_bias", "constant offset of each component" + absolute + "10 % of the largest torque when absent"},
          {"torque_noise", "slow noise of each component" + absolute + "2 % of the largest torque when absent"},
          {"torque_hysteresis",
           "offset along the sign of the rate of change" + absolute + "3 % of the largest torque when absent"}};
}

LoadTolerance read_load_tolerance(const Value& arguments, bool has_direction, bool has_torque) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const LoadTolerance usual;
  LoadTolerance out;
  if (arguments.has("scale") && arguments.at("scale").type() == Value::Type::map) out.gain = 0.0;
  out.gain = arguments.number_or("gain", out.gain, 0.0, 1.0, "-");
  out.bias = arguments.number_or("bias", out.bias, 0.0, infinity, "");
  out.noise = arguments.number_or("noise", out.noise, 0.0, infinity, "");
  out.correlation_time =
      arguments.number_or("correlation_time", out.correlation_time, std::numeric_limits<double>::min(), infinity, "s");
  out.delay = arguments.number_or("delay", out.delay, 0.0, 10.0, "s");
  out.hysteresis = arguments.number_or("hysteresis", out.hysteresis, 0.0, infinity, "");
  out.direction = has_direction ? arguments.number_or("direction", out.direction, 0.0, 1.0, "rad") : 0.0;
  if (!has_torque) return out;
  out.torque_bias = arguments.number_or("torque_bias", usual.bias, 0.0, infinity, "N m");
  out.torque_noise = arguments.number_or("torque_noise", usual.noise, 0.0, infinity, "N m");
  out.torque_hysteresis = arguments.number_or("torque_hysteresis", usual.hysteresis, 0.0, infinity, "N m");
  return out;
}

std::vector<std::pair<std::string, std::string>> motion_error_keys() {
  return {{"gain", "relative error of the travel, 1 sigma; 0.002 when absent"},
          {"noise", "slow noise of each component of the position [m], 1 sigma; 5e-5 when absent"},
          {"correlation_time", "of the slow noise [s]; 0.5 when absent"},
          {"delay", "how late the pose is stamped [s], 1 sigma; 0.01 when absent"},
          {"direction", "rotation of the pose's frame about each axis [rad], 1 sigma; 0.01 when absent"}};
}

LoadTolerance read_motion_tolerance(const Value& arguments) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  LoadTolerance out;
  out.bias = out.hysteresis = 0.0;  // the motion counts from rest
  out.smooth = true;
  out.gain = arguments.number_or("gain", 0.002, 0.0, 1.0, "-");
  out.noise = arguments.number_or("noise", 5e-5, 0.0, infinity, "m");
  out.correlation_time =
      arguments.number_or("correlation_time", out.correlation_time, std::numeric_limits<double>::min(), infinity, "s");
  out.delay = arguments.number_or("delay", out.delay, 0.0, 10.0, "s");
  out.direction = arguments.number_or("direction", 0.01, 0.0, 1.0, "rad");
  return out;
}

LoadErrorBasis::LoadErrorBasis(const LoadTolerance& tolerance, const Load& measured, int components, double begin,
                               double end)
    : tolerance_(tolerance), components_(components), begin_(begin), rates_(Eigen::VectorXd::Zero(components)) {
  std::vector<Part> parts{{0, std::min(components, 3), "", "", tolerance.bias, tolerance.noise, tolerance.hysteresis}};
  if (components == 6) {
    parts.push_back({3, 3, "torque ", "N m", tolerance.torque_bias, tolerance.torque_noise, tolerance.torque_hysteresis});
  }
  for (Part& part : parts) measure(measured, end, part);
  place_knots(end);
  const Part whole{0, components, "", "", 0.0, 0.0, 0.0};
  add(Error::gain, whole, 1, tolerance.gain, "-");
  for (const Part& part : parts) add(Error::bias, part, part.rows, part.bias, part.unit);
  add(Error::delay, whole, 1, tolerance.delay, "s");
  for (const Part& part : parts) add(Error::hysteresis, part, part.rows, part.hysteresis, part.unit);
  if (components >= 3) add(Error::direction, whole, 3, tolerance.direction, "rad");
  const auto knots = static_cast<int>(knots_.cols());
  for (const Part& part : parts) add(Error::noise, part, part.rows * knots, part.noise, part.unit);
}

// Finds the size and the rate of a part's load, of which its errors may be shares.
void LoadErrorBasis::measure(const Load& measured, double end, Part& part) {
  double largest = 0.0, square = 0.0;
  for (int k = 0; k <= kSamples; ++k) {
    const double time = begin_ + (end - begin_) * k / kSamples;
    largest = std::max(largest, measured(time).segment(part.row, part.rows).norm());
    square += rate(measured, time).segment(part.row, part.rows).squaredNorm();
  }
  rates_.segment(part.row, part.rows).setConstant(std::sqrt(square / (part.rows * (kSamples + 1))));
  for (double* std : {&part.bias, &part.noise, &part.hysteresis}) {
    if (*std < 0.0) *std *= -largest;
  }
}

void LoadErrorBasis::place_knots(double end) {
  const double span = std::max(end - begin_, 1e-6);
  const int count =
      std::clamp(static_cast<int>(std::ceil(kKnotsPerTime * span / tolerance_.correlation_time)) + 1, 2, kMostKnots);
  spacing_ = span / (count - 1);
  Eigen::MatrixXd covariance(count, count);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) covariance(i, j) = correlation(tolerance_, std::abs(i - j) * spacing_);
  }
  knots_ = Eigen::MatrixXd(covariance.llt().matrixL());
}

void LoadErrorBasis::add(Error error, const Part& part, int count, double std, const std::string& unit) {
  if (!(std > 0.0)) return;
  groups_.push_back({error, part.prefix + name_of(error), size_, count, std, unit, part.row, part.rows});
  size_ += count;
}

// The noise decays beyond the last knot.
Eigen::RowVectorXd LoadErrorBasis::hats(double time) const {
  Eigen::RowVectorXd out = Eigen::RowVectorXd::Zero(knots_.rows());
  const double at = (time - begin_) / spacing_, last = static_cast<double>(knots_.rows() - 1);
  const double inside = std::clamp(at, 0.0, last);
  const auto low = std::min(static_cast<Eigen::Index>(inside), knots_.rows() - 2);
  const double s = inside - static_cast<double>(low);
  const double share = tolerance_.smooth ? s * s * (3.0 - 2.0 * s) : s;  // a smooth one has no kinks at the knots
  out[low] = 1.0 - share;
  out[low + 1] = share;
  return out * std::exp(-std::abs(at - inside) * spacing_ / tolerance_.correlation_time);
}

Eigen::MatrixXd LoadErrorBasis::value(const Load& measured, double time) const {
  const auto errors = [&](double now) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(components_, size_);
    const Eigen::VectorXd load = measured(now), slope = rate(measured, now);
    for (const Group& group : groups_) {
      auto block = out.block(group.row, group.first, group.rows, group.count);
      switch (group.error) {
        case Error::gain:
          block = group.std * load;
          break;
        case Error::bias:
          block.diagonal().setConstant(group.std);
          break;
        case Error::delay:
          block = -group.std * slope;
          break;
        case Error::hysteresis:
          for (int i = 0; i < group.rows; ++i) {
            const double turning = std::max(kTurning * rates_[group.row + i], std::numeric_limits<double>::min());
            block(i, i) = group.std * std::tanh(slope[group.row + i] / turning);
          }
          break;
        case Error::direction:
          for (int row = 0; row < group.rows; row += 3) {
            const Eigen::Vector3d vector = load.segment<3>(row);
            for (int i = 0; i < 3; ++i) block.block<3, 1>(row, i) = group.std * Eigen::Vector3d::Unit(i).cross(vector);
          }
          break;
        case Error::noise:
          const Eigen::RowVectorXd row = group.std * hats(now) * knots_;
          for (int i = 0; i < group.rows; ++i) block.block(i, i * knots_.cols(), 1, knots_.cols()) = row;
          break;
      }
    }
    return out;
  };
  // A motion counts from rest, and so does its error: else the body would be jolted there.
  return tolerance_.smooth ? errors(time) - errors(begin_) : errors(time);
}

}  // namespace tissue_stiffness
