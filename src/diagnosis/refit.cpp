#include "diagnosis/refit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "diagnosis/fit_entries.hpp"
#include "diagnosis/model_comparison.hpp"
#include "fit/nested_parameters.hpp"
#include "settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kShares[] = {0.6, 1.0};  // of the training frames, fitted in turn from a known place

struct Start {
  Eigen::VectorXd w, spread;
  BatchFit fit;  ///< from there, without full runs
};

// Returns the tangent's amplitude of an added parameter; NaN where it has none. The amplitude's components come in order.
double tangent_value(const FreeParameter& parameter, const RefitTask& task, Eigen::Index& taken) {
  if (!task.candidate->has_amplitude(parameter.name) || taken == task.amplitude.size())
    return std::numeric_limits<double>::quiet_NaN();
  return task.candidate->absent + task.amplitude[taken++];
}

// Returns the base's fit with the proposal's prior, preceded by one with the tangent's amplitude where that is allowed.
std::vector<Start> starts(const RecordingFit& recording_fit, const RecordingFit& base, const Eigen::VectorXd& w,
                          const RefitTask& task) {
  const auto& free = recording_fit.model().parameters().free();
  const NestedParameters shared(recording_fit, base);
  Start prior{shared.extend(w), shared.spread(), {}};
  Start tangent = prior;
  Eigen::Index taken = 0;
  bool differs = false;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (base.index(free[i].name) >= 0) continue;
    if (const double amplitude = tangent_value(free[i], task, taken); std::isfinite(amplitude)) {
      const double value = std::clamp(amplitude, free[i].lower, free[i].upper);
      const bool allowed = free[i].prior.kind != Quantity::Kind::log_normal || value > 0.0;
      tangent.w[k] = allowed ? free[i].to_coordinate(value) : prior.w[k];
      differs = differs || allowed;
    }
  }
  return differs ? std::vector<Start>{tangent, prior} : std::vector<Start>{prior};
}

// Starts at these parameters, the others at their priors.
Start start_of(const RecordingFit& recording_fit, const std::map<std::string, double>& parameters) {
  const Model& model = recording_fit.model();
  return {model.parameters().coordinates(parameters, model.parameters().prior_mean()),
          NestedParameters(recording_fit, recording_fit).spread(),
          {}};
}

// Returns the start whose fit without full runs is best. A run that rings may need the base's parameters in another
// minimum.
std::optional<Start> quick_start(const RecordingFit& recording_fit, const RecordingFit& base,
                                 const std::vector<Start>& starts, double rival, std::string& reason) {
  const std::vector<Eigen::Index> tuning = NestedParameters(recording_fit, base).scanned();
  std::optional<Start> best;
  for (Start start : starts) {
    try {
      start.w = recording_fit.scan_near(start.w, tuning).w;
      start.fit = recording_fit.quick_fit(start.w, start.spread, 1.0, best ? std::min(rival, best->fit.cost) : rival);
      if (!best || start.fit.cost < best->fit.cost) best = std::move(start);
    } catch (const NumericalError& error) {
      reason = error.what();
    }
  }
  return best;
}

// Goes from a known place to a fit of all training frames.
Start grown(const RecordingFit& recording_fit, Start start, double rival) {
  for (const double share : kShares) {
    start.fit = recording_fit.quick_fit(start.w, start.spread, share, share < 1.0 ? no_rival : rival);
    start.w = start.fit.w;
  }
  return start;
}

// Returns where the quick runs of a model fit best. What was linearised about the run itself is near already, and a first
// order holds only near the base.
Start quick_fit_of(const RecordingFit& quick, const FittedModel& base, const RefitTask& task, bool near_base,
                   double rival) {
  if (!task.start.empty()) return grown(quick, start_of(quick, task.start), rival);
  const RecordingFit& known = *base.recording_fit;
  if (task.candidate->linearised || !task.candidate->linear) {
    Start start = starts(quick, known, base.fit.w, task).front();
    start.fit = quick.quick_fit(start.w, start.spread, 1.0, rival);
    return start;
  }
  std::string reason;
  std::vector<Start> from = starts(quick, known, base.fit.w, task);
  if (near_base) from.resize(1);
  std::optional<Start> start = quick_start(quick, known, from, rival, reason);
  if (!start) throw NumericalError(task.effect() + " cannot be refitted: " + reason);
  return *start;
}

// Corrects the quick runs of a model by those of the base, and trains them with what the tangent says of its motion.
void borrow(RecordingFit& recording_fit, const FittedModel& base, const RefitTask& task) {
  const Candidate& candidate = *task.candidate;
  const RecordingFit& known = *base.recording_fit;
  if (!candidate.linearised) return recording_fit.borrow(known);
  const Eigen::VectorXd w = starts(recording_fit, known, base.fit.w, task).front().w;
  Eigen::VectorXd seen = NestedParameters(*candidate.linearised, known).extend(base.fit.w);
  seen.segment(candidate.parameter, task.amplitude.size()) += task.amplitude;
  recording_fit.borrow(known, w, candidate.linearised.get(), seen);
}

// Fits the base with the task's proposal. `in_full` says whether a nonlinear model was run in full.
FittedModel fit_extended(const FittedModel& base, const RefitTask& task, const RefitLimits& limits, bool& in_full) {
  const RecordingFit& known = *base.recording_fit;
  const ModelSettings settings = extend_model(known.model().settings(), {task.candidate->proposal.refine});
  const bool at_first_order = !task.candidate->linear && !known.model().nonlinear();
  BasisOptions basis = RecordingFit::keeping_root();
  if (at_first_order) basis.nonlinear = BasisOptions::Nonlinear::first_order;
  FittedModel out;
  out.recording_fit = std::make_unique<RecordingFit>(settings, known, basis);
  borrow(*out.recording_fit, base, task);
  const bool nonlinear = out.recording_fit->model().nonlinear();
  const double rival = nonlinear ? base.fit.cost - limits.least_gain : limits.rival;
  const Start start = quick_fit_of(*out.recording_fit, base, task, limits.near_base, rival);
  out.fit = start.fit;
  out.rows = out.recording_fit->rows(out.fit.w);
  const double gain = base.rows.error.squaredNorm() - out.rows.error.squaredNorm();
  in_full = nonlinear && gain > limits.least_gain;
  if (!in_full) return out;
  if (at_first_order) out.recording_fit = std::make_unique<RecordingFit>(settings, known);
  out.fit = out.recording_fit->fit(start.fit.w, start.spread, limits.rival);
  out.rows = out.recording_fit->rows(out.fit.w);  // the last full run was at just this place
  return out;
}

// Takes over what a fit of the base with the refit's proposal has found.
void describe(const FittedModel& base, const FittedModel& fitted, const FittedSteps& steps, double rival,
              double steps_rival, Refit& out) {
  const RecordingFit& known = *base.recording_fit;
  const Model& model = fitted.recording_fit->model();
  std::vector<EffectEntry> entries{out.proposed};
  fit_entries(entries, model, fitted.fit);
  out.entry = entries.front();
  out.parameters = model.parameters().values(fitted.fit.w);
  const auto numerics = fitted.fit.cost > rival ? FittedNumerics::none : FittedNumerics::evident;
  out.explained = std::make_shared<const Explained>(
      compared_residual(fitted, added_amplitudes(*fitted.recording_fit, known), numerics, steps, steps_rival));
  RecordingRows compared = fitted.rows;
  compared.error = out.explained->error;
  out.held_out_rms = rms_error(compared, known.recording(), true);
  out.fitted = fitted.fit.cost;
  out.cost = fitted.rows.error.squaredNorm();
}

}  // namespace

Refit refit_with(const FittedModel& base, const RefitTask& task, const RefitLimits& limits) {
  bool in_full = false;
  auto fitted = std::make_shared<FittedModel>(fit_extended(base, task, limits, in_full));
  Refit out;
  out.effect = task.effect();
  out.candidate = task.candidate;
  out.proposed = task.candidate->proposal.refine;
  describe(base, *fitted, limits.steps, limits.rival, limits.steps_rival, out);
  if (in_full || !fitted->recording_fit->model().nonlinear()) out.model = std::move(fitted);
  return out;
}

void choose_basis_at_fit(const FittedModel& base, const FittedSteps& steps, Refit& refit) {
  const RecordingFit& known = *refit.model->recording_fit;
  if (known.model().nonlinear()) return;
  auto own = std::make_shared<FittedModel>();
  own->recording_fit = std::make_unique<RecordingFit>(known.model().settings(), *base.recording_fit,
                                                      RecordingFit::chosen_at(refit.model->fit));
  own->fit = own->recording_fit->quick_fit(refit.model->fit.w, NestedParameters(known, known).spread());
  own->rows = own->recording_fit->rows(own->fit.w);
  describe(base, *own, steps, no_rival, no_rival, refit);
  refit.model = std::move(own);
}

}  // namespace tissue_stiffness
