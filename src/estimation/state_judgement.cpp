#include "estimation/state_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "types/formatted.hpp"
#include "types/two_digits.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLearnt = 0.5;        // of the prior's standard deviation: what a settled estimate may have left
constexpr double kInvalidScale = 4.0;  // mean square of all frames' misfit over the noise's

std::string percent(double share) {
  return std::to_string(static_cast<int>(std::lround(100.0 * share))) + " %";
}

// Returns the indices of the parameters that a state speaks of: the moduli, or all where none is free.
std::vector<Eigen::Index> judged(const std::vector<FreeParameter>& free) {
  std::vector<Eigen::Index> moduli, all;
  for (std::size_t i = 0; i < free.size(); ++i) {
    all.push_back(static_cast<Eigen::Index>(i));
    if (is_young_modulus(free[i].name)) moduli.push_back(all.back());
  }
  return moduli.empty() ? all : moduli;
}

StateJudgement by_shape(const StateEvidence& e) {
  const MisfitTest& test = e.systematic.test();
  if (test.passes() && e.misfit_has_risen)
    return {EstimateState::converging, "the misfit has risen since it was tested, and is tested again"};
  if (test.passes()) return {EstimateState::converged, "the misfit is noise"};
  if (e.mesh_pending) return {EstimateState::converging, "the error of the mesh has not been estimated yet"};
  return {EstimateState::doubtful, misfit_text(test)};
}

// A model that runs in full is judged by the size of its misfit alone.
StateJudgement by_size(const StateEvidence& e) {
  if (std::pow(e.misfit.rms_sigma, 2) <= std::pow(kFullSigmas, 2) + e.systematic.of_mesh())
    return {EstimateState::converged, "the misfit is about the noise"};
  return {EstimateState::doubtful, "the misfit is " + two_digits(e.misfit.rms_sigma) + " times the noise"};
}

}  // namespace

std::string misfit_text(const MisfitTest& test) {
  return formatted(
      "along the body's lowest modes, and in forces, the misfit is %s times the noise's variance, %.1f standard deviations "
      "beyond what passes",
      two_digits(1.0 + test.excess()).c_str(), test.z());
}

std::string unlearnt(const std::vector<FreeParameter>& free, const Eigen::MatrixXd& covariance, double widest,
                     const std::vector<std::string>& known_before) {
  const Eigen::VectorXd std = covariance.diagonal().cwiseSqrt();
  for (const Eigen::Index i : judged(free)) {
    const FreeParameter& one = free[static_cast<std::size_t>(i)];
    const bool positive = one.prior.kind == Quantity::Kind::log_normal;
    const bool known = std::find(known_before.begin(), known_before.end(), one.name) != known_before.end();
    if (!known && std[i] > kLearnt * one.prior_std()) return one.name + " is hardly better known than its prior";
    if (positive && std[i] > widest) return one.name + " is known to " + percent(std[i]) + " only";
  }
  return "";
}

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
  if (of_misfit.state != EstimateState::converged) return of_misfit;
  std::string why =
      unlearnt(e.model.parameters().free(), e.covariance, e.converged_within, e.model.settings().known_before);
  if (!why.empty()) return {unknown, std::move(why)};
  return of_misfit;
}

}  // namespace tissue_stiffness
