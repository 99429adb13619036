#include "tissue_stiffness/diagnosis/diagnose.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
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
#include "tissue_stiffness/types/stop_request.hpp"

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

/// The search: what is known so far is always in `out`.
class Search {
 public:
  Search(const Recording& recording, const DiagnosisOptions& options, Diagnosis& out)
      : recording_(recording), options_(options), out_(out) {
    options_.progress = [this, tell = options.progress](const std::string& step, std::size_t done, std::size_t total) {
      out_.interrupted = step;
      tell(step, done, total);
    };
  }

  void judge_given(const ModelSettings& settings, const TetMesh& mesh) {
    options_.progress("fit of the given model", 0, 0);
    model_ = fit_model(settings, mesh, recording_);
    describe_residual(model_, std::numeric_limits<double>::quiet_NaN(), out_);
    add_step();
    finding_ = look(model_, {}, options_, {}, {}, [&](std::vector<MissingEffect> candidates) {
      out_.candidates = std::move(candidates);
      publish();
    });
    out_.verdict = out_.final_verdict = finding_.verdict;
    out_.set = finding_.set;
    out_.best = best_of(model_, finding_);
    out_.candidates = finding_.effects;
    out_.next_experiment = next_experiment(finding_.set);
    out_.sigmas.numerical = finding_.floor;
    out_.metres.numerical = finding_.floor * out_.metres.noise;
    publish();
    if (!lacks_something()) return;
    options_.progress("the force that is missing", 0, 0);
    out_.force = missing_force(*model_.study, believed(model_, finding_));
  }

  void add_effects() {
    const std::size_t asked = options_.add.size();
    const std::size_t most = asked + static_cast<std::size_t>(options_.automatic ? options_.most_steps : 0);
    for (std::size_t k = 0; k < most; ++k) {
      if (k >= asked && !lacks_something()) break;
      const std::vector<Refit> refits =
          k < asked ? look(model_, {options_.add[k]}, options_, finding_.finer, finding_.library).refits : finding_.refits;
      if (refits.empty() || (k >= asked && !worth_adding(refits.front()))) break;
      const Library library = add(refits.front());
      if (k + 1 >= asked && is_noise(model_.rows, finding_.floor)) {
        out_.final_verdict = "adequate";
        break;
      }
      finding_ = look(model_, {}, options_, finding_.finer, library);
      out_.final_verdict = finding_.verdict;
    }
  }

  void conclude() {
    // What was added first was fitted while the rest was missing.
    fit_entries(out_.entries, model_.study->model(), model_.fit);
    estimate(doubt_of_nonlinear(model_, recording_));
    options_.progress("run the models once more for the report", 0, 0);
    publish();
    options_.at_end(out_, given_.study ? given_ : model_, model_, finding_.finer.study.get());
    out_.interrupted.clear();
  }

 private:
  bool lacks_something() const { return finding_.verdict == "missing" || finding_.verdict == "unexplained"; }

  bool worth_adding(const Refit& refit) const {
    return proven(model_, refit) && (finding_.verdict != "unexplained" || takes_a_part(model_, refit, recording_));
  }

  // The library of tangents that the next look may take over.
  Library add(const Refit& best) {
    for (const std::string& effect : best.effects) options_.progress("add " + effect, 0, 0);
    Fitted next = extended(model_, best);
    Library library = same_body(model_.study->model(), next.study->model()) ? std::move(finding_.library) : Library();
    out_.final_effects.insert(out_.final_effects.end(), best.effects.begin(), best.effects.end());
    out_.entries.insert(out_.entries.end(), best.entries.begin(), best.entries.end());
    out_.final_verdict = "unfinished";
    if (!given_.study) given_ = std::move(model_);
    model_ = std::move(next);
    add_step();
    return library;
  }

  void add_step() {
    out_.steps.push_back(step_of(model_, recording_, out_.final_effects));
    estimate(Eigen::MatrixXd::Zero(model_.fit.w.size(), model_.fit.w.size()));
    publish();
  }

  void estimate(const Eigen::MatrixXd& doubt) {
    out_.estimate = summarise(model_.study->model().free_parameters(), model_.fit.w, model_.fit.covariance + doubt);
  }

  void publish() {
    out_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    options_.so_far(out_);
  }

  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  const Recording& recording_;
  DiagnosisOptions options_;
  Diagnosis& out_;
  Fitted given_, model_;  ///< given_ is empty as long as model_ is the given one
  Finding finding_;       ///< of model_
};

}  // namespace

Diagnosis diagnose(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                   const DiagnosisOptions& options) {
  if (recording.frames.size() < kFewestFrames) {
    throw InputError(settings.name, std::to_string(recording.frames.size()) + " usable frames",
                     "at least " + std::to_string(kFewestFrames) + " to hold some of them out");
  }
  for (const std::string& name : options.ignore) effect_spec({name, name, {}});  // throws what is none
  Diagnosis out;
  Search search(recording, options, out);
  try {
    search.judge_given(settings, mesh);
    search.add_effects();
    search.conclude();
  } catch (const Interrupted&) {  // `out` says during what
  }
  return out;
}

}  // namespace tissue_stiffness
