#include "tissue_stiffness/diagnosis/diagnose.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "tissue_stiffness/diagnosis/finding.hpp"
#include "tissue_stiffness/diagnosis/first_look.hpp"
#include "tissue_stiffness/diagnosis/fit_entries.hpp"
#include "tissue_stiffness/diagnosis/missing_force.hpp"
#include "tissue_stiffness/diagnosis/residual_views.hpp"
#include "tissue_stiffness/effects/registry.hpp"
#include "tissue_stiffness/estimation/mesh_error.hpp"
#include "tissue_stiffness/estimation/posterior.hpp"
#include "tissue_stiffness/forward/extra_force.hpp"
#include "tissue_stiffness/settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kFewestFrames = 18;
constexpr double kBaseSpread = 0.1;     // prior standard deviations, of the sigma points of the first fit
constexpr double kLeastDeficit = 0.01;  // of the mean squared error in sigmas: the stated noise is too large
constexpr double kWorthAdding = 0.2;
constexpr double kAddedSpread = 0.02;  // and of a model's that starts from a refit

Fitted fit_model(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording) {
  Fitted out;
  out.study = std::make_unique<Study>(settings, mesh, recording);
  const Eigen::VectorXd start = out.study->scan(out.study->model().prior_mean());
  out.fit = out.study->fit(start, kBaseSpread * out.study->model().prior_std());
  out.rows = out.study->rows(out.fit.w);
  return out;
}

// The refit's model; run in full where that was not worth it before.
Fitted extended(const Fitted& base, const Refit& refit) {
  if (refit.model) return std::move(*refit.model);
  Fitted out;
  out.study = std::make_unique<Study>(extend_model(base.study->model().settings(), refit.entries), *base.study);
  const Model& model = out.study->model();
  out.fit = out.study->fit(model.coordinates(refit.parameters, model.prior_mean()), kAddedSpread * model.prior_std());
  out.rows = out.study->rows(out.fit.w);
  return out;
}

DiagnosisStep step_of(const Fitted& model, const Recording& recording, const std::vector<std::string>& effects) {
  DiagnosisStep step;
  step.effects = effects;
  step.parameters = model.study->model().values(model.fit.w);
  step.train_rms = rms_error(model.rows, recording, false);
  step.held_out_rms = rms_error(model.rows, recording, true);
  step.noise_floor = noise_floor(model.rows);
  return step;
}

// What `next` has beyond the model acts on the body, or in a sensor, and leaves the body's own mass and stiffness alone.
bool same_body(const Model& model, const Model& next) {
  return std::all_of(next.parts().begin(), next.parts().end(), [&model](const Model::Part& part) {
    const auto same = [&part](const Model::Part& known) { return known.label == part.label; };
    const LinearTerms& terms = part.terms;
    return std::any_of(model.parts().begin(), model.parts().end(), same) ||
           (terms.mass.empty() && terms.stiffness.empty() && terms.strain_stiffness.empty() && !adds_extra_force(part));
  });
}

// The noise that the model file states, and what the mesh adds to it: there is nothing left to look for.
bool is_noise(const Study::Rows& rows, double of_mesh) {
  const double square = rows.error.squaredNorm() / rows.count();
  return square > 1.0 - kLeastDeficit && square < kExplained * kExplained * unavoidable_mean_square(of_mesh);
}

void describe_residual(const Fitted& model, double floor, Diagnosis& out) {
  out.where = where_it_fails(*model.study, model.rows);
  out.when = when_it_fails(*model.study, model.rows);
  out.residual = residual_views(*model.study, model.rows);
  const double count = model.rows.count();
  const double sigma = noise_floor(model.rows);
  out.sigmas = {std::sqrt(model.rows.error.squaredNorm() / count), 1.0, floor, 0.0};
  out.sigmas.structured = std::sqrt(std::max(0.0, out.sigmas.total * out.sigmas.total - 1.0));
  const double total = std::sqrt(model.rows.error.cwiseProduct(model.rows.sigma).squaredNorm() / count);
  out.metres = {total, sigma, floor * sigma, std::sqrt(std::max(0.0, total * total - sigma * sigma))};
}

// Of the held-out error beyond noise. Where nothing explains the error, what takes less of it is not what is missing.
bool takes_a_part(const Fitted& model, const Refit& refit, const Recording& recording) {
  const auto beyond = [](double sigmas) { return std::max(0.0, sigmas * sigmas - 1.0); };
  return beyond(refit.held_out_sigmas) < (1.0 - kWorthAdding) * beyond(rms_sigmas(model.rows, recording, true));
}

BestExplanation best_of(const Fitted& model, const Finding& finding) {
  if (finding.refits.empty()) return {};
  const Refit& best = finding.refits.front();
  return {best.effects, 1.0 - best.cost / model.rows.error.squaredNorm(), best.held_out_rms};
}

// Of a linear model its estimator finds this out, and corrects E.
Eigen::MatrixXd doubt_of_nonlinear(const Fitted& fitted, const Recording& recording) {
  const Model& model = fitted.study->model();
  const Eigen::VectorXd& w = fitted.fit.w;
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(w.size(), w.size());
  if (!model.nonlinear() || !MeshError::why_not(model).empty()) return none;
  const MeshError::Question question(model, recording.frames, w, fitted.fit.covariance.diagonal().cwiseSqrt(),
                                     model.prior_std());
  try {
    return mesh_doubt(model, MeshError(model, model.theta(w)).study(question).shift);
  } catch (const NumericalError&) {
    return none;
  }
}

// The model's parameters as the best explanation has them: without it they make up for what is missing.
Eigen::VectorXd believed(const Fitted& model, const Finding& finding) {
  if (finding.verdict != "missing") return model.fit.w;
  return model.study->model().coordinates(finding.refits.front().parameters, model.fit.w);
}

}  // namespace

Diagnosis diagnose(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                   const DiagnosisOptions& options) {
  const auto clock = std::chrono::steady_clock::now();
  if (recording.frames.size() < kFewestFrames) {
    throw InputError(settings.name, std::to_string(recording.frames.size()) + " usable frames",
                     "at least " + std::to_string(kFewestFrames) + " to hold some of them out");
  }
  for (const std::string& name : options.ignore) effect_spec({name, name, {}});  // throws what is none
  Diagnosis out;
  options.progress("fit of the given model", 0, 0);
  Fitted given, model = fit_model(settings, mesh, recording);
  out.steps.push_back(step_of(model, recording, {}));
  Finding finding = look(model, {}, options);
  if (finding.verdict == "missing" || finding.verdict == "unexplained") {
    options.progress("the force that is missing", 0, 0);
    out.force = missing_force(*model.study, believed(model, finding));
  }
  describe_residual(model, finding.floor, out);
  out.verdict = out.final_verdict = finding.verdict;
  out.set = finding.set;
  out.best = best_of(model, finding);
  out.candidates = finding.effects;
  out.next_experiment = next_experiment(finding.set);

  const std::size_t asked = options.add.size();
  const std::size_t most = asked + static_cast<std::size_t>(options.automatic ? options.most_steps : 0);
  for (std::size_t k = 0; k < most; ++k) {
    if (k >= asked && finding.verdict != "missing" && finding.verdict != "unexplained") break;
    const std::vector<Refit> refits =
        k < asked ? look(model, {options.add[k]}, options, finding.finer, finding.library).refits : finding.refits;
    if (refits.empty() || (k >= asked && !proven(model, refits.front()))) break;
    if (k >= asked && finding.verdict == "unexplained" && !takes_a_part(model, refits.front(), recording)) break;
    const Refit& best = refits.front();
    for (const std::string& effect : best.effects) options.progress("add " + effect, 0, 0);
    Fitted next = extended(model, best);
    const Library library = same_body(model.study->model(), next.study->model()) ? std::move(finding.library) : Library();
    out.final_effects.insert(out.final_effects.end(), best.effects.begin(), best.effects.end());
    out.entries.insert(out.entries.end(), best.entries.begin(), best.entries.end());
    if (!given.study) given = std::move(model);
    model = std::move(next);
    out.steps.push_back(step_of(model, recording, out.final_effects));
    if (k + 1 >= asked && is_noise(model.rows, finding.floor)) {
      out.final_verdict = "adequate";
      break;
    }
    finding = look(model, {}, options, finding.finer, library);
    out.final_verdict = finding.verdict;
  }
  fit_entries(out.entries, model.study->model(), model.fit);  // what was added first was fitted while the rest was missing
  out.estimate = summarise(model.study->model().free_parameters(), model.fit.w,
                           model.fit.covariance + doubt_of_nonlinear(model, recording));
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  options.at_end(out, given.study ? given : model, model, finding.finer.study.get());
  return out;
}

}  // namespace tissue_stiffness
