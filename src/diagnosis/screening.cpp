#include "diagnosis/screening.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "effects/registry.hpp"
#include "forward/for_each_index.hpp"

namespace tissue_stiffness {
namespace {

// Returns the effects that are not searched for. What a simulation puts into its recording is no missing physics, unless it
// is asked for.
std::vector<std::string> left_out_effects(const DiagnosisOptions& options) {
  std::vector<std::string> out = options.ignore;
  for (const EffectSpec& spec : effect_specs()) {
    if (spec.of_simulation && std::count(options.add.begin(), options.add.end(), spec.name) == 0) out.push_back(spec.name);
  }
  return out;
}

std::size_t effects_in(const std::vector<Candidate>& candidates) {
  std::set<std::string> names;
  for (const Candidate& candidate : candidates) names.insert(candidate.effect);
  return names.size();
}

void keep_wanted(std::vector<Candidate>& candidates, const std::vector<std::string>& wanted) {
  if (wanted.empty()) return;
  const auto other = [&](const Candidate& c) { return std::count(wanted.begin(), wanted.end(), c.effect) == 0; };
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(), other), candidates.end());
}

}  // namespace

Screening::Screening(FittedModel& fitted, const DiagnosisOptions& options, PreviousRound previous,
                     const std::vector<std::string>& wanted)
    : base(fitted),
      cost(fitted.rows.error.squaredNorm()),
      beside_another(previous.beside_another),
      settled(previous.settled),
      rival(previous.rival),
      library(wanted.empty() ? std::move(previous.library) : Library()),
      explained(compared_residual(base)),
      comparison(base, Eigen::VectorXd::Zero(base.rows.error.size())),
      given(comparison.assess(explained)) {
  if (previous.models) comparison.note(*previous.models);
  if (!given.strict_test.passes()) explained = compared_residual(base, {}, FittedNumerics::far);
  candidates = propose_candidates(*base.recording_fit, base.fit.w, left_out_effects(options));
  effect_count = effects_in(candidates);
  keep_wanted(candidates, wanted);
  const std::string step = "tangents of the library, and what a finer mesh would change";
  options.progress(step, 0, 0);
  run_side_by_side(
      [&] {
        read_tangents(
            *base.recording_fit, base.fit.w, candidates,
            [&](std::size_t done, std::size_t total) { options.progress(step, done, total); }, library);
      },
      [&] { finer = finer_mesh(base, previous.finer.get()); });
  comparison.allow_for_mesh(mesh_change(base, finer));
  given = comparison.assess(explained);
  const Eigen::MatrixXd &own = explained.linearisation.columns, &of_mesh = comparison.mesh_directions();
  nuisance_tangents.resize(own.rows(), own.cols() + of_mesh.cols());
  nuisance_tangents << own, of_mesh;
  nuisance_tangents = comparison.whitened(nuisance_tangents);
  error = comparison.whitened(explained.error);
  for_each_index(candidates.size(), [&](std::size_t c) {
    candidates[c].tangent.columns = comparison.whitened(candidates[c].tangent.columns);
  });
  scorer = std::make_unique<Scorer>(error, nuisance_tangents, comparison.noise_variance());
  discretisation_error = finer.change.norm() / std::sqrt(base.rows.count());
  ranked = rank_effects(*scorer, candidates);
}

double Screening::least_gain() const {
  return std::max(kComparison.promising * structured_squares(base.rows),
                  2.0 * kComparison.worthwhile * comparison.noise_variance());
}

void Screening::move_base(const BatchFit& fit, ModelComparison& models) {
  base.fit = fit;
  base.rows = base.recording_fit->rows(fit.w);
  cost = base.rows.error.squaredNorm();
  explained = compared_residual(base, {}, given.strict_test.passes() ? FittedNumerics::evident : FittedNumerics::far);
  finer = finer_mesh(base, finer.recording_fit.get());
  discretisation_error = finer.change.norm() / std::sqrt(base.rows.count());
  models.move_base(base.rows.error, mesh_change(base, finer));
}

}  // namespace tissue_stiffness
