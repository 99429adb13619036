#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tissue_stiffness/diagnosis/ranking.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kBaseSpread = 0.05;   // prior standard deviations, of the base's parameters at first
constexpr double kAddedSpread = 0.25;  // and of the added ones
constexpr double kLeastFactor = 1.02;  // of a log-normal prior in the proposed model file
constexpr double kPriorWidth = 5.0;    // posterior standard deviations

struct Start {
  Eigen::VectorXd w, spread;
};

// The base's fit, and the proposal's prior; with the tangent's amplitude in its place where that is allowed.
std::vector<Start> starts(const Study& study, const Study& base, const Eigen::VectorXd& w, const Ranked& candidate) {
  const auto& free = study.model().free_parameters();
  Start prior{study.model().prior_mean(), kAddedSpread * study.model().prior_std()};
  Start tangent = prior;
  Eigen::Index component = 0;
  bool differs = false;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const Eigen::Index known = base.index(free[i].name);
    if (known >= 0) {
      prior.w[k] = w[known];
      prior.spread[k] = kBaseSpread * study.model().prior_std()[k];
    } else if (free[i].name.find("." + candidate.best->proposal.amplitude) != std::string::npos &&
               component < candidate.score.amplitude.size()) {
      const double value = std::clamp(candidate.score.amplitude[component++], free[i].lower, free[i].upper);
      const bool allowed = free[i].prior.kind != Quantity::Kind::log_normal || value > 0.0;
      tangent.w[k] = allowed ? free[i].to_coordinate(value) : prior.w[k];
      differs = differs || allowed;
      continue;
    }
    tangent.w[k] = prior.w[k];
    tangent.spread[k] = prior.spread[k];
  }
  return differs ? std::vector<Start>{tangent, prior} : std::vector<Start>{prior};
}

// "name: {key: value, ...}" with every estimated parameter's quantity replaced by its fit.
std::string fitted_entry(const Study& study, const Study& base, const BatchFit& fit, const std::string& entry) {
  std::string out = entry;
  for (std::size_t i = 0; i < study.model().free_parameters().size(); ++i) {
    const FreeParameter& p = study.model().free_parameters()[i];
    if (base.index(p.name) >= 0) continue;
    const std::string key = p.name.substr(p.name.rfind('.') + 1);
    const auto k = static_cast<Eigen::Index>(i);
    const double width = kPriorWidth * std::sqrt(fit.covariance(k, k));
    const bool vector = key.size() > 2 && key.compare(key.size() - 2, 2, "_x") == 0 && k + 2 < fit.w.size();
    const std::string name = vector ? key.substr(0, key.size() - 2) : key;
    const auto at = out.find(name + ": {");
    if (at == std::string::npos) continue;  // second and third components are written with the first
    if (vector) {
      const Eigen::Vector3d mean = fit.w.segment<3>(k);
      out.replace(at, out.find('}', at) + 1 - at, name + ": " + normal(mean, std::max(width, 1e-3 * p.prior.spread)));
      continue;
    }
    const bool positive = p.prior.kind == Quantity::Kind::log_normal;
    const std::string quantity =
        positive ? log_normal(p.to_value(fit.w[k]), std::max(std::exp(std::min(width, 3.0)), kLeastFactor))
                 : normal(p.to_value(fit.w[k]), std::max(width, 1e-3 * p.prior.spread));
    out.replace(at, out.find('}', at) + 1 - at, key + ": " + quantity);
  }
  return out;
}

}  // namespace

Refit refit(const Study& base, const Eigen::VectorXd& w, const Ranked& candidate) {
  ModelSettings settings = base.model().settings();
  add_effect(settings, candidate.best->proposal.refine);
  const Study study(settings, base.model().mesh(), base.recording());
  std::optional<BatchFit> best;
  std::string reason;
  for (const Start& start : starts(study, base, w, candidate)) {
    try {
      BatchFit fit = study.fit(start.w, start.spread, false);
      if (!best || fit.cost < best->cost) best = std::move(fit);
    } catch (const NumericalError& error) {
      reason = error.what();
    }
  }
  if (!best) throw NumericalError(candidate.effect + " cannot be refitted: " + reason);
  const Study::Rows rows = study.rows(best->w);
  Refit out;
  out.effect = candidate.effect;
  out.entry = fitted_entry(study, base, *best, candidate.best->proposal.refine);
  for (std::size_t i = 0; i < study.model().free_parameters().size(); ++i) {
    const FreeParameter& p = study.model().free_parameters()[i];
    out.parameters[p.name] = p.to_value(best->w[static_cast<Eigen::Index>(i)]);
  }
  out.train_rms = rms_error(rows, base.recording(), false);
  out.held_out_rms = rms_error(rows, base.recording(), true);
  out.train_sigmas = rms_sigmas(rows, base.recording(), false);
  out.held_out_sigmas = rms_sigmas(rows, base.recording(), true);
  out.cost = rows.error.squaredNorm();
  out.added_parameters = static_cast<int>(study.model().free_parameters().size() - base.model().free_parameters().size());
  return out;
}

}  // namespace tissue_stiffness
