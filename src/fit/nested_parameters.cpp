#include "fit/nested_parameters.hpp"

#include <algorithm>
#include <iterator>
#include <memory>

namespace tissue_stiffness {
namespace {

constexpr double kBaseSpread = 0.05;   // prior standard deviations, for parameters that the base has too
constexpr double kAddedSpread = 0.25;  // prior standard deviations, for the others
constexpr Eigen::Index kShifted = 12;  // lowest modes whose frequencies tell by how much a parameter shifts them

}  // namespace

NestedParameters::NestedParameters(const RecordingFit& fit, const RecordingFit& base) : fit_(fit), base_(base) {
  for (std::size_t i = 0; i < fit_.model().parameters().free().size(); ++i) {
    if (base_.index(fit_.model().parameters().free()[i].name) >= 0) all_.push_back(static_cast<Eigen::Index>(i));
  }
}

bool NestedParameters::tunes(Eigen::Index parameter) const {
  const ParameterSpace& parameters = fit_.model().parameters();
  const Eigen::VectorXd w = parameters.prior_mean();
  Eigen::VectorXd there = w;
  there[parameter] += parameters.prior_std()[parameter];
  return !fit_.model().same_answer(parameters.theta(w), parameters.theta(there));
}

std::vector<Eigen::Index> NestedParameters::tuning() const {
  std::vector<Eigen::Index> out;
  std::copy_if(all_.begin(), all_.end(), std::back_inserter(out), [this](Eigen::Index i) { return tunes(i); });
  return out;
}

std::vector<Eigen::Index> NestedParameters::scanned() const {
  std::vector<Eigen::Index> out = tuning();
  if (!fit_.linear() || out.size() < 2) return out;
  const std::shared_ptr<const ReducedModel> linear = fit_.reduced();
  const Eigen::VectorXd w = fit_.model().parameters().prior_mean(), std = fit_.model().parameters().prior_std();
  const auto lowest = [&](const Eigen::VectorXd& there) {
    const Eigen::ArrayXd square = linear->modes(fit_.model().parameters().theta(there))->square;
    return Eigen::ArrayXd(
        square.head(std::min(kShifted, square.size())).max(ReducedModes::kRigid * square.maxCoeff()).log());
  };
  const Eigen::ArrayXd here = lowest(w);
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(w.size());
  for (const Eigen::Index i : out) {
    const Eigen::ArrayXd there = lowest(w + std[i] * Eigen::VectorXd::Unit(w.size(), i));
    const Eigen::Index modes = std::min(here.size(), there.size());
    shift[i] = (there.head(modes) - here.head(modes)).abs().mean();
  }
  Eigen::Index most = 0;
  shift.maxCoeff(&most);
  const auto weaker = [&](Eigen::Index i) { return i != most && shift[i] > 0.0; };
  out.erase(std::remove_if(out.begin(), out.end(), weaker), out.end());
  return out;
}

std::vector<Eigen::Index> NestedParameters::acting() const {
  std::vector<Eigen::Index> out = all_;
  for (const Eigen::Index i : tuning()) out.erase(std::find(out.begin(), out.end(), i));
  return out;
}

Eigen::VectorXd NestedParameters::extend(const Eigen::VectorXd& w) const {
  Eigen::VectorXd out = fit_.model().parameters().prior_mean();
  for (const Eigen::Index i : all_) {
    out[i] = w[base_.index(fit_.model().parameters().free()[static_cast<std::size_t>(i)].name)];
  }
  return out;
}

Eigen::VectorXd NestedParameters::spread() const {
  const Eigen::VectorXd prior = fit_.model().parameters().prior_std();
  Eigen::VectorXd out = kAddedSpread * prior;
  for (const Eigen::Index i : all_) out[i] = kBaseSpread * prior[i];
  return out;
}

}  // namespace tissue_stiffness
