#pragma once

#include <cmath>
#include <cstring>

#include "../box_model.hpp"
#include "verification/experiment.hpp"

namespace tissue_stiffness {

constexpr double kNoise = 1e-4;   // [m], the default of box_settings
constexpr double kFilmed = 0.02;  // [s] between frames

inline std::string modulus(const std::string& value, const std::string& region = "") {
  return "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: " + value +
         (region.empty() ? "}" : ", region: " + region + "}");
}

/// Returns {prior, factor} as a model file has it.
inline std::string prior(double median, double factor) {
  return "{prior: " + std::to_string(median) + ", factor: " + std::to_string(factor) + "}";
}

/// Returns the effects of a clamped bar of the given modulus under gravity.
inline std::vector<std::string> bar_under_gravity(const std::string& young_modulus) {
  return {"inertia: {density: 1000}", modulus(young_modulus), "fixed: {region: clamp}",
          "gravity: {acceleration: [0.5, 1, -3]}"};
}

/// Returns the force and torque of a tool that sways along y and pushes down along z, at these rates [rad/s].
inline LoadSample swaying_wrench(double time, double y_rate = 6.0, double z_rate = 4.0) {
  LoadSample sample{"/wrench", time, Eigen::VectorXd::Zero(6)};
  sample.value[1] = 4e-3 * std::sin(y_rate * time);
  sample.value[2] = -6e-3 * (1.0 - std::cos(z_rate * time));
  return sample;
}

/// Feeds the loads of the first 0.3 s to the bar and to its estimator.
inline void load_briefly(Experiment& bar, Estimator& estimator) {
  for (int k = 0; k < 60; ++k) {
    bar.add_load(swaying_wrench(0.005 * k));
    estimator.add_load(swaying_wrench(0.005 * k));
  }
}

/// Returns the result of the last frame.
inline StepResult step_through(Estimator& estimator, const std::vector<Frame>& frames) {
  StepResult last;
  for (const Frame& frame : frames) last = estimator.step(frame);
  return last;
}

inline double value(Estimator& estimator, std::size_t parameter = 0) {
  return estimator.estimate().parameters.at(parameter).mean;
}

inline bool holds(const ParameterEstimate& parameter, double truth) {
  return parameter.lower95 <= truth && truth <= parameter.upper95;
}

/// Returns every number and word of an estimate and of the body's state, byte by byte.
inline std::string bytes(Estimator& estimator) {
  std::string out;
  const auto append = [&out](const double* data, Eigen::Index count) {
    out.append(reinterpret_cast<const char*>(data), static_cast<std::size_t>(count) * sizeof(double));
  };
  const Estimate& estimate = estimator.estimate();
  append(&estimate.time, 1);
  out += to_string(estimate.state);
  for (const ParameterEstimate& p : estimate.parameters) {
    out += p.name + p.unit;
    for (const double* number : {&p.mean, &p.std, &p.lower95, &p.upper95}) append(number, 1);
  }
  append(estimate.covariance.data(), estimate.covariance.size());
  append(estimator.displacement().data(), estimator.displacement().size());
  append(estimator.prediction().predicted.data(), estimator.prediction().predicted.size());
  for (const auto& [name, identifiable] : estimator.identifiability())
    out += name + identifiable.verdict + identifiable.reason;
  for (const Misfit& misfit : estimator.free_run()) append(&misfit.rms, 1);
  return out;
}

}  // namespace tissue_stiffness
