#include "forward/parameter_space.hpp"

#include <algorithm>
#include <cmath>

#include "effects/registry.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSpeedLimit = 1e4;                          // [m/s], bound of the initial velocity
const Quantity kAnySpeed{Quantity::Kind::normal, 0.0, 1.0};  // [m/s], until frames tell

}  // namespace

double FreeParameter::to_value(double w) const {
  const double value = prior.kind == Quantity::Kind::log_normal ? std::exp(w) : w;
  return std::clamp(value, lower, upper);
}

double FreeParameter::to_coordinate(double value) const {
  return prior.kind == Quantity::Kind::log_normal ? std::log(value) : value;
}

double FreeParameter::prior_std() const {
  return prior.kind == Quantity::Kind::log_normal ? std::log(prior.spread) : prior.spread;
}

std::vector<int> ParameterSpace::add(const EffectSettings& effect, bool exact_inputs) {
  std::vector<int> indices;
  const std::vector<Quantity> quantities = read_parameters(effect);
  auto quantity = quantities.begin();
  for (const ParameterSpec& spec : effect_spec(effect).parameters) {
    for (int c = 0; c < spec.components; ++c, ++quantity) {
      const auto index = static_cast<int>(known_.size());
      known_.conservativeResize(index + 1);
      known_[index] = quantity->value;
      indices.push_back(index);
      const std::string suffix = spec.components > 1 ? std::string("_") + "xyz"[c] : "";
      const std::string name = effect.label + "." + spec.name + suffix;
      if (quantity->estimated()) {
        free_.push_back({name, spec.unit, *quantity, spec.lower, spec.upper});
        free_index_.push_back(index);
      } else if (quantity->tolerance > 0.0 && !exact_inputs) {
        constants_.push_back({name, index, quantity->value, quantity->tolerance});
      }
    }
  }
  return indices;
}

void ParameterSpace::add_initial_velocity(const InitialSettings& initial) {
  const auto offset = known_.size();
  known_.conservativeResize(offset + 3);
  known_.tail<3>() = initial.velocity;
  velocity_is_free_ = initial.kind == InitialSettings::Kind::from_frames;
  for (int i = 0; velocity_is_free_ && i < 3; ++i) {
    free_.push_back({std::string("initial.velocity_") + "xyz"[i], "m/s", kAnySpeed, -kSpeedLimit, kSpeedLimit});
    free_index_.push_back(static_cast<int>(offset) + i);
  }
}

void ParameterSpace::set_velocity_prior(const Eigen::Vector3d& mean, double std) {
  for (std::size_t i = 0; i < 3; ++i) {
    free_[free_.size() - 3 + i].prior = {Quantity::Kind::normal, mean[static_cast<Eigen::Index>(i)], std};
  }
}

void ParameterSpace::forget_velocity_prior() {
  for (std::size_t i = 0; velocity_is_free_ && i < 3; ++i) free_[free_.size() - 3 + i].prior = kAnySpeed;
}

void ParameterSpace::know(const Eigen::VectorXd& theta) {
  known_ = theta;
  free_.clear();
  free_index_.clear();
  velocity_is_free_ = false;
}

bool ParameterSpace::is_free(int index) const {
  return std::find(free_index_.begin(), free_index_.end(), index) != free_index_.end();
}

Eigen::VectorXd ParameterSpace::theta(const Eigen::VectorXd& w) const {
  Eigen::VectorXd result = known_;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    result[free_index_[i]] = free_[i].to_value(w[static_cast<Eigen::Index>(i)]);
  }
  return result;
}

Eigen::VectorXd ParameterSpace::prior_mean() const {
  Eigen::VectorXd w(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) w[static_cast<Eigen::Index>(i)] = free_[i].prior_mean();
  return w;
}

Eigen::VectorXd ParameterSpace::prior_std() const {
  Eigen::VectorXd s(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) s[static_cast<Eigen::Index>(i)] = free_[i].prior_std();
  return s;
}

Eigen::VectorXd ParameterSpace::drift() const {
  Eigen::VectorXd d(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) d[static_cast<Eigen::Index>(i)] = free_[i].prior.drift;
  return d;
}

std::map<std::string, double> ParameterSpace::values(const Eigen::VectorXd& w) const {
  std::map<std::string, double> out;
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const FreeParameter& free = free_[static_cast<std::size_t>(i)];
    out[free.name] = free.to_value(w[i]);
  }
  return out;
}

Eigen::VectorXd ParameterSpace::coordinates(const std::map<std::string, double>& values, Eigen::VectorXd w) const {
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const FreeParameter& free = free_[static_cast<std::size_t>(i)];
    const auto value = values.find(free.name);
    if (value != values.end()) w[i] = free.to_coordinate(value->second);
  }
  return w;
}

}  // namespace tissue_stiffness
