#include "tissue_stiffness/diagnosis/first_look.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tissue_stiffness/effects/registry.hpp"
#include "tissue_stiffness/forward/for_each_index.hpp"

namespace tissue_stiffness {
namespace {

// What a simulated recording has of its making is no missing physics, unless it is asked for.
std::vector<std::string> not_looked_for(const DiagnosisOptions& options) {
  std::vector<std::string> out = options.ignore;
  for (const EffectSpec& spec : effect_specs()) {
    if (spec.of_simulation && std::count(options.add.begin(), options.add.end(), spec.name) == 0) out.push_back(spec.name);
  }
  return out;
}

// Of a mesh that cannot be refined it is a part of the motion.
Eigen::VectorXd mesh_change(const Fitted& base, const FinerMesh& finer) {
  const bool unknown = finer.study == nullptr && base.study->model().settings().mesh.discretisation_error;
  return unknown ? kComparison.unknown_mesh * motion_of(base.rows).cwiseProduct(base.rows.used) : finer.change;
}

}  // namespace

FirstLook::FirstLook(Fitted& fitted, const DiagnosisOptions& options, Earlier earlier)
    : base(fitted),
      cost(fitted.rows.error.squaredNorm()),
      search(earlier.search),
      settled(earlier.settled),
      library(std::move(earlier.library)),
      explained(explain(base)),
      comparison(base, Eigen::VectorXd::Zero(base.rows.error.size())),
      given(comparison.assess(explained)) {
  if (earlier.models) comparison.note(*earlier.models);
  if (!given.test.passes()) explained = explain(base, {}, true);
  const std::string step = "tangents of the library, and what a finer mesh would change";
  options.progress(step, 0, 0);
  run_side_by_side(
      [&] {
        candidates = find_candidates(
            *base.study, base.fit.w, not_looked_for(options),
            [&](std::size_t done, std::size_t total) { options.progress(step, done, total); }, library);
      },
      [&] { finer = finer_mesh(base, earlier.finer.get()); });
  comparison.allow_for_mesh(mesh_change(base, finer));
  given = comparison.assess(explained);
  const Eigen::MatrixXd &own = explained.linearisation.columns, &of_mesh = comparison.mesh_directions();
  known.resize(own.rows(), own.cols() + of_mesh.cols());
  known << own, of_mesh;
  known = comparison.whitened(known);
  error = comparison.whitened(explained.error);
  for_each_index(candidates.size(), [&](std::size_t c) {
    candidates[c].tangent.columns = comparison.whitened(candidates[c].tangent.columns);
  });
  scorer = std::make_unique<Scorer>(error, known, comparison.noise_variance());
  floor = finer.change.norm() / std::sqrt(base.rows.count());
  ranked = rank(*scorer, candidates);
}

void FirstLook::move_base(const BatchFit& fit) {
  base.fit = fit;
  base.rows = base.study->rows(fit.w);
  cost = base.rows.error.squaredNorm();
  explained = explain(base, {}, !given.test.passes());
  comparison.note(base.rows.error);
}

}  // namespace tissue_stiffness
