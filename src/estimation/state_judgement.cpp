#include "estimation/state_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace tissue_stiffness {
namespace {

constexpr double kLearnt = 0.5;          // of the prior's standard deviation: what a settled estimate may have left
constexpr double kWidest = 0.2;          // relative standard deviation of an estimate that is called converged
constexpr double kInvalidScale = 4.0;    // mean square of all frames' misfit over the noise's
constexpr double kInvalidSigmas = 10.0;  // rms error over noise at which the model says nothing about the body

std::string percent(double share) {
  return std::to_string(static_cast<int>(std::lround(100.0 * share))) + " %";
}

// Returns the indices of the parameters that a state speaks of: the moduli, or all where none is free.
std::vector<Eigen::Index> judged(const Model& model) {
  std::vector<Eigen::Index> moduli, all;
  for (std::size_t i = 0; i < model.parameters().free().size(); ++i) {
    all.push_back(static_cast<Eigen::Index>(i));
    if (is_young_modulus(model.parameters().free()[i].name)) moduli.push_back(all.back());
  }
  return moduli.empty() ? all : moduli;
}

// Returns why the estimate is not precise enough to be used; empty: it is.
std::string unlearnt(const Model& model, const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd std = covariance.diagonal().cwiseSqrt(), prior = model.parameters().prior_std();
  const std::vector<std::string>& before = model.settings().known_before;
  for (const Eigen::Index i : judged(model)) {
    const FreeParameter& free = model.parameters().free()[static_cast<std::size_t>(i)];
    const bool positive = free.prior.kind == Quantity::Kind::log_normal;
    const bool known = std::find(before.begin(), before.end(), free.name) != before.end();
    if (!known && std[i] > kLearnt * prior[i]) return free.name + " is hardly better known than its prior";
    if (positive && std[i] > kWidest) return free.name + " is known to " + percent(std[i]) + " only";
  }
  return "";
}

StateJudgement by_shape(const StateEvidence& e) {
  const MisfitTest& test = e.systematic.test();
  if (test.passes()) return {EstimateState::converged, "the misfit is noise"};
  if (e.mesh_pending) return {EstimateState::converging, "the error of the mesh has not been estimated yet"};
  char text[200];
  std::snprintf(text, sizeof text,
                "along the body's lowest modes the misfit is %.2g times the noise's variance, %.1f standard deviations "
                "beyond what passes",
                1.0 + test.excess(), test.z());
  return {EstimateState::doubtful, text};
}

// A model that runs in full is judged by the size of its misfit alone.
StateJudgement by_size(const StateEvidence& e) {
  if (std::pow(e.misfit.rms_sigma, 2) <= std::pow(kFullSigmas, 2) + e.systematic.of_mesh())
    return {EstimateState::converged, "the misfit is about the noise"};
  char text[100];
  std::snprintf(text, sizeof text, "the misfit is %.2g times the noise", e.misfit.rms_sigma);
  return {EstimateState::doubtful, text};
}

}  // namespace

StateJudgement judge_state(const StateEvidence& e) {
  if (e.misfit.count == 0) return {EstimateState::no_data, "nothing was observed"};
  if (e.change_suspected) return {EstimateState::drifting, "the misfit has risen, as it does when a parameter changes"};
  if (e.misfit.rms_sigma > kInvalidSigmas || (e.invalid && e.misfit_scale > kInvalidScale))
    return {EstimateState::model_invalid, "no value of the parameters explains the motion"};
  if (!e.stale_load.empty()) return {EstimateState::stale, e.stale_load};
  const EstimateState unknown = e.changing ? EstimateState::drifting : EstimateState::converging;
  const auto& inputs = e.systematic.inputs();
  if (!inputs) return {EstimateState::converging, "the errors of the inputs have not been estimated yet"};
  if (e.restudying) return {EstimateState::converging, "the errors of the inputs are estimated again"};
  if (!e.settled) return {unknown, "the estimate still moves out of its own interval"};
  if (!inputs->implausible.empty()) return {EstimateState::doubtful, inputs->implausible};
  StateJudgement of_misfit = inputs->fitted ? by_shape(e) : by_size(e);
  if (of_misfit.state == EstimateState::doubtful) return of_misfit;
  if (std::string why = unlearnt(e.model, e.covariance); !why.empty()) return {unknown, std::move(why)};
  return of_misfit;
}

}  // namespace tissue_stiffness
