#include "tissue_stiffness/diagnosis/diagnose.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "diagnosis/belief_map.hpp"
#include "diagnosis/describe.hpp"
#include "diagnosis/fit_entries.hpp"
#include "diagnosis/fit_given_model.hpp"
#include "diagnosis/missing_force.hpp"
#include "diagnosis/mix_explanations.hpp"
#include "diagnosis/pair_search.hpp"
#include "diagnosis/residual_views.hpp"
#include "diagnosis/rounds.hpp"
#include "diagnosis/try_run.hpp"
#include "effects/registry.hpp"
#include "estimation/mesh_error.hpp"
#include "estimation/posterior.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/repeated_observation.hpp"
#include "types/stop_request.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kFewestFrames = 18;

// Returns the recording as the estimator would take it: without the frames during which a load was silent, and without
// observations that came twice.
Recording usable_part(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                      std::string& left_out) {
  Recording out = recording;
  for (Frame& frame : out.frames) leave_out_repeats(frame);
  if (recording.loads.empty()) return out;
  Model model(settings, mesh);
  model.loads().drive(recording.first_stamp, recording.loads);
  std::string why;
  const auto silent = [&](const Frame& frame) {
    const std::string silence = model.loads().silence(frame.time);
    if (!silence.empty()) why = silence;
    return !silence.empty();
  };
  out.frames.erase(std::remove_if(out.frames.begin(), out.frames.end(), silent), out.frames.end());
  if (why.empty()) return out;
  const std::size_t all = recording.frames.size();
  left_out = std::to_string(all - out.frames.size()) + " of " + std::to_string(all) + " frames (" + why + ")";
  return out;
}

// Returns zero for a linear model, whose estimator finds this out and corrects E.
Eigen::MatrixXd mesh_discrepancy_of_nonlinear(const FittedModel& fitted, const Recording& recording) {
  const Model& model = fitted.recording_fit->model();
  const Eigen::VectorXd& w = fitted.fit.w;
  Eigen::MatrixXd none = Eigen::MatrixXd::Zero(w.size(), w.size());
  if (!model.nonlinear() || !MeshError::why_not(model).empty()) return none;
  const MeshError::Question question(model, recording.frames, w, fitted.fit.covariance.diagonal().cwiseSqrt(),
                                     model.parameters().prior_std());
  try {
    return mesh_discrepancy(model, MeshError(model, model.parameters().theta(w)).study(question).shift);
  } catch (const NumericalError&) {
    return none;
  }
}

// Returns the model's parameters as the best explanation has them: without it they compensate for what is missing.
Eigen::VectorXd believed(const FittedModel& model, const Finding& finding) {
  if (finding.verdict != Verdict::missing) return model.fit.w;
  return model.recording_fit->model().parameters().coordinates(finding.refits.front().parameters, model.fit.w);
}

/// The search keeps all that is known so far in `out`.
class ModelSearch {
 public:
  ModelSearch(const Recording& recording, const DiagnosisOptions& options, Diagnosis& out)
      : recording_(recording), options_(options), out_(out) {
    options_.progress = [this, tell = options.progress](const std::string& step, std::size_t done, std::size_t total) {
      out_.interrupted = step;
      tell(step, done, total);
    };
  }

  void judge_given(const ModelSettings& settings, const TetMesh& mesh) {
    options_.progress("fit of the given model", 0, 0);
    model_ = fit_given_model(settings, mesh, recording_);
    describe_residual(model_, out_);
    options_.progress("compare the given model with the recording", 0, 0);
    add_step(compared_residual(model_), 0.0);
    bool moved = false;
    finding_ = examine(model_, options_, {}, moved, [&](std::vector<MissingEffect> candidates) {
      out_.candidates = std::move(candidates);
      publish();
    });
    if (moved) {
      replace_step();
      describe_residual(model_, out_);
    }
    if (finding_.verdict == Verdict::unexplained) grown_ = search_pairs(model_, finding_, recording_, options_);
    out_.verdict = out_.final_verdict = finding_.verdict;
    out_.adequate = finding_.comparison.given().probability;
    out_.none_of_these = finding_.comparison.none_of_these();
    out_.z = finding_.comparison.given().test.z;
    out_.set = finding_.set;
    out_.best = best_explanation(model_, finding_.comparison);
    out_.candidates = finding_.effects;
    out_.next_experiment = next_experiment(out_.set, out_.best);
    out_.valid_given = out_.valid_final = validity();
    out_.sigmas.numerical = finding_.discretisation_error;
    out_.metres.numerical = finding_.discretisation_error * out_.metres.noise;
    publish();
    if (!lacks_something()) return;
    options_.progress("the force that is missing", 0, 0);
    out_.force = missing_force(*model_.recording_fit, believed(model_, finding_));
  }

  void add_effects() {
    const std::size_t asked = options_.add.size();
    const std::size_t most = asked + static_cast<std::size_t>(options_.automatic ? options_.most_steps : 0);
    for (std::size_t k = 0; k < most; ++k) {
      if (k >= asked && finding_.verdict != Verdict::missing) break;
      if (!add_one(k < asked ? options_.add[k] : "")) break;
    }
  }

  void conclude() {
    if (!out_.final_effects.empty()) out_.valid_final = validity();
    // What was added first was fitted while the rest was missing, so its prior takes the last fit.
    fit_entries(entries_, model_.recording_fit->model(), model_.fit);
    out_.entries.clear();
    for (const EffectEntry& entry : entries_) out_.entries.push_back(to_yaml(entry));
    estimate(mesh_discrepancy_of_nonlinear(model_, recording_));
    out_.traces = traces_of(finding_, model_);
    options_.progress("run the models once more for the report", 0, 0);
    publish();
    options_.at_end(out_, given_.recording_fit ? given_ : model_, model_, finding_.previous.finer.get());
    std::vector<std::vector<RivalExplanation>> mixed = out_.rivals;
    mixed.push_back(out_.traces);
    mix_explanations(mixed, out_.estimate.parameters);
    out_.interrupted.clear();
  }

 private:
  bool lacks_something() const { return finding_.verdict == Verdict::missing || finding_.verdict == Verdict::unexplained; }

  Assessment assessment() const { return finding_.models->assess(explained_); }
  BeliefMap validity() const { return belief_map(model_, assessment().left, *finding_.models); }

  // Adds the `wanted` effect, or the best one if it is empty, and judges what is left. Returns false where that cannot be
  // done; the diagnosis then says why.
  bool add_one(const std::string& wanted) {
    std::string reason;
    const std::string name = wanted.empty() ? finding_.refits.front().effect : wanted;
    const Refit* refit = refit_of(finding_, name);
    std::optional<Finding> asked;
    if (refit == nullptr) {  // the search had no reason to fit it
      asked = diagnose_once(model_, {name}, options_, finding_.previous);
      refit = refit_of(*asked, name);
      if (refit == nullptr && asked->failure.empty()) {
        throw InputError("--add", name, "an effect that the library proposes for this model");
      }
    }
    if (grown_ && refit != &finding_.refits.front()) grown_.reset();  // what was found beside another effect
    Library library;
    const auto add_it = [&] { library = add(*refit); };
    if (refit == nullptr || !try_run(recording_, add_it, &reason)) {
      out_.failure = name + " cannot be added: " + (refit == nullptr ? asked->failure : reason);
      return false;
    }
    const auto judge_it = [&] {
      bool moved = false;
      finding_ = grown_ ? std::move(*grown_) : examine(model_, options_, after_adding(finding_, library), moved);
      if (moved) replace_step();
    };
    const bool judged = try_run(recording_, judge_it, &reason);
    if (!judged) out_.failure = "what is left beside " + name + " cannot be judged: " + reason;
    grown_.reset();
    out_.final_verdict = judged ? finding_.verdict : Verdict::unexplained;
    return judged;
  }

  // Returns the library of tangents that the next round may take over. Nothing changes where it throws NumericalError.
  Library add(const Refit& best) {
    options_.progress("add " + best.effect, 0, 0);
    FittedModel next = extended(model_, best);
    Explained explained = compared_residual(next);
    Library library = library_for(model_, next, finding_);
    // What is found beside another effect was compared beside that one only.
    out_.rivals.push_back(grown_ ? std::vector<RivalExplanation>() : rivals_of(finding_, best));
    out_.final_effects.push_back(best.effect);
    entries_.push_back(best.entry);
    out_.entries.push_back(to_yaml(best.entry));
    out_.final_verdict = Verdict::unfinished;
    if (!given_.recording_fit) given_ = std::move(model_);
    model_ = std::move(next);
    add_step(std::move(explained), best.log_bayes_factor);
    return library;
  }

  void add_step(Explained explained, double log_bayes_factor) {
    explained_ = std::move(explained);
    out_.steps.push_back(describe_step(model_, explained_, out_.final_effects));
    out_.steps.back().log_bayes_factor = log_bayes_factor;
    publish_step();
  }

  // Replaces the last step after the model has been fitted anew. This may be interrupted, so what is published stays whole.
  void replace_step() {
    Explained explained = compared_residual(model_);
    const double log_bayes_factor = out_.steps.back().log_bayes_factor;
    out_.steps.pop_back();
    add_step(std::move(explained), log_bayes_factor);
  }

  void publish_step() {
    estimate(Eigen::MatrixXd::Zero(model_.fit.w.size(), model_.fit.w.size()));
    publish();
  }

  void estimate(const Eigen::MatrixXd& discrepancy) {
    out_.estimate = summarise_posterior(model_.recording_fit->model().parameters().free(), model_.fit.w,
                                        model_.fit.covariance + discrepancy);
  }

  void publish() {
    out_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    options_.so_far(out_);
  }

  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  const Recording& recording_;
  DiagnosisOptions options_;
  Diagnosis& out_;
  FittedModel given_, model_;         ///< given_ is empty as long as model_ is the given one
  Explained explained_;               ///< model_ as it is compared
  Finding finding_;                   ///< of model_
  std::optional<Finding> grown_;      ///< of model_ with the best refit; empty where that explains the error alone
  std::vector<EffectEntry> entries_;  ///< of out_.final_effects
};

}  // namespace

Diagnosis diagnose(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                   const DiagnosisOptions& options) {
  for (const std::string& name : options.ignore) effect_spec({name, name, {}});  // throws for an unknown effect
  Diagnosis out;
  const Recording usable = usable_part(settings, mesh, recording, out.left_out);
  if (usable.frames.size() < kFewestFrames) {
    const std::string why = out.left_out.empty() ? "" : "; left out: " + out.left_out;
    throw InputError(settings.name, std::to_string(usable.frames.size()) + " usable frames" + why,
                     "at least " + std::to_string(kFewestFrames) + " to hold some of them out");
  }
  ModelSearch search(usable, options, out);
  try {
    search.judge_given(settings, mesh);
    search.add_effects();
    search.conclude();
  } catch (const Interrupted&) {  // `out` says during which step
  }
  return out;
}

}  // namespace tissue_stiffness
