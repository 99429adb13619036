#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tissue_stiffness/diagnosis/fit_entries.hpp"
#include "tissue_stiffness/diagnosis/model_comparison.hpp"
#include "tissue_stiffness/diagnosis/ranking.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSpread = 0.05;          // prior standard deviations, around the fit of a beginning
constexpr double kShares[] = {0.6, 1.0};  // of the training frames, fitted one after the other from a fit of the beginning

struct Start {
  Eigen::VectorXd w, spread;
  BatchFit fit;  ///< from there, without full runs
};

// The tangent's amplitude of an added parameter; NaN where it has none. Amplitudes' components come in order.
double tangent_value(const FreeParameter& parameter, const Addition& addition, Eigen::Index& taken) {
  const bool amplitude = parameter.name.find("." + addition.way->proposal.amplitude) != std::string::npos;
  if (!amplitude || taken == addition.amplitude.size()) return std::numeric_limits<double>::quiet_NaN();
  return addition.way->absent + addition.amplitude[taken++];
}

double scanned_value(const FreeParameter& parameter, const Addition& addition) {
  const auto known = addition.scanned.find(parameter.name);
  const std::string amplitude = addition.effect() + "." + addition.way->proposal.amplitude;
  const bool scanned = known != addition.scanned.end() && parameter.name.rfind(amplitude, 0) != 0;
  return scanned ? known->second : std::numeric_limits<double>::quiet_NaN();
}

// The base's fit, and the proposal's prior; with the tangent's amplitude in its place where that is allowed.
std::vector<Start> starts(const Study& study, const Study& base, const Eigen::VectorXd& w, const Addition& addition) {
  const auto& free = study.model().free_parameters();
  Start prior{study.extend(base, w), study.spread_beyond(base), {}};
  Start tangent = prior;
  Eigen::Index taken = 0;
  bool differs = false;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (base.index(free[i].name) >= 0) continue;
    if (const double amplitude = tangent_value(free[i], addition, taken); std::isfinite(amplitude)) {
      const double value = std::clamp(amplitude, free[i].lower, free[i].upper);
      const bool allowed = free[i].prior.kind != Quantity::Kind::log_normal || value > 0.0;
      tangent.w[k] = allowed ? free[i].to_coordinate(value) : prior.w[k];
      differs = differs || allowed;
    } else if (const double value = scanned_value(free[i], addition); std::isfinite(value)) {
      prior.w[k] = tangent.w[k] = free[i].to_coordinate(value);
    }
  }
  return differs ? std::vector<Start>{tangent, prior} : std::vector<Start>{prior};
}

// Where the beginning's fit left all parameters.
Start start_of(const Study& study, const std::map<std::string, double>& parameters) {
  const Model& model = study.model();
  return {model.coordinates(parameters, model.prior_mean()), kSpread * model.prior_std(), {}};
}

// The start whose fit without full runs is best. A run that rings may need the base's parameters in another minimum.
std::optional<Start> quick_start(const Study& study, const Study& base, const std::vector<Start>& starts, double rival,
                                 std::string& reason) {
  const std::vector<Eigen::Index> tuning = study.tuning_shared_with(base);
  std::optional<Start> best;
  for (Start start : starts) {
    try {
      start.w = study.scan_near(start.w, tuning).w;
      start.fit = study.quick_fit(start.w, start.spread, 1.0, best ? std::min(rival, best->fit.cost) : rival);
      if (!best || start.fit.cost < best->fit.cost) best = std::move(start);
    } catch (const NumericalError& error) {
      reason = error.what();
    }
  }
  return best;
}

// From a fit of the beginning to one of everything.
Start grown(const Study& study, Start start, double rival) {
  for (const double share : kShares) {
    start.fit = study.quick_fit(start.w, start.spread, share, share < 1.0 ? no_rival : rival);
    start.w = start.fit.w;
  }
  return start;
}

}  // namespace

Refit refit(const Fitted& base, const Addition& addition, double rival) {
  const Study& known = *base.study;
  auto model = std::make_shared<Fitted>();
  ModelSettings settings = known.model().settings();
  add_effect(settings, addition.way->proposal.refine);
  model->study = std::make_unique<Study>(settings, known);
  const Study& study = *model->study;
  model->study->borrow(known);
  if (study.model().nonlinear()) rival = no_rival;  // quick runs are off
  std::string reason;
  std::optional<Start> start = addition.begun
                                   ? grown(study, start_of(study, addition.scanned), rival)
                                   : quick_start(study, known, starts(study, known, base.fit.w, addition), rival, reason);
  if (!start) throw NumericalError(addition.effect() + " cannot be refitted: " + reason);
  Study::Rows& rows = model->rows = study.rows(start->fit.w);
  const double gain = base.rows.error.squaredNorm() - rows.error.squaredNorm();
  const bool only_quick = known.model().nonlinear() && gain < kComparison.promising * structured_squares(base.rows);
  if (study.model().nonlinear() && !only_quick) {
    start->fit = study.fit(start->fit.w, start->spread);
    rows = study.rows(start->fit.w);  // the last full run was at just this place
  }
  model->fit = start->fit;
  Refit out;
  out.effect = addition.effect();
  out.way = addition.way;
  std::vector<EffectEntry> entries{addition.way->proposal.refine};
  fit_entries(entries, study.model(), start->fit);
  out.entry = entries.front();
  out.parameters = study.model().values(start->fit.w);
  out.explained = std::make_shared<const Explained>(explain(*model, added_amplitudes(study, known)));
  Study::Rows compared = rows;
  compared.error = out.explained->error;
  out.held_out_rms = rms_error(compared, known.recording(), true);
  out.fitted = start->fit.cost;
  out.cost = rows.error.squaredNorm();
  if (!only_quick) out.model = std::move(model);
  return out;
}

}  // namespace tissue_stiffness
