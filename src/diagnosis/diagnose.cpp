#include "tissue_stiffness/diagnosis/diagnose.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "diagnosis/belief_map.hpp"
#include "diagnosis/describe.hpp"
#include "diagnosis/estimate_at_last.hpp"
#include "diagnosis/finding.hpp"
#include "diagnosis/fit_entries.hpp"
#include "diagnosis/missing_force.hpp"
#include "diagnosis/mix_explanations.hpp"
#include "diagnosis/residual_views.hpp"
#include "diagnosis/screening.hpp"
#include "diagnosis/try_run.hpp"
#include "effects/registry.hpp"
#include "estimation/mesh_error.hpp"
#include "estimation/posterior.hpp"
#include "forward/extra_force.hpp"
#include "forward/hyper_basis.hpp"
#include "settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/repeated_observation.hpp"
#include "types/stop_request.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kFewestFrames = 18;
constexpr double kBaseSpread = 0.1;            // prior standard deviations, of the sigma points of the first fit
constexpr double kShares[] = {0.1, 0.2, 0.4};  // of the training frames
constexpr int kMostBases = 3;                  // rounds that are repeated because the model fits better elsewhere
constexpr std::size_t kGrown = 2;              // leaders that are tried as one of several effects
constexpr double kAddedSpread = 0.02;          // prior standard deviations, of those of a model that starts from a refit

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

// A scan of the modulus over all frames says nothing while it is not known how the body starts. The first frames tell both,
// whatever the prior, so such a model is fitted to more and more of them.
Eigen::VectorXd starting_point(const RecordingFit& recording_fit) {
  const ParameterSpace& parameters = recording_fit.model().parameters();
  Eigen::VectorXd w = parameters.prior_mean();
  if (!recording_fit.model().starts_in_motion()) return recording_fit.scan(w);
  for (const double share : kShares) w = recording_fit.quick_fit(w, kBaseSpread * parameters.prior_std(), share).w;
  return w;
}

// A scan of finite strain runs only what is linear in it, which may be far from the recording. The estimator runs the model
// itself, so the fit begins where the better of both is.
Eigen::VectorXd starting_point_of_finite(const RecordingFit& recording_fit) {
  const Model& model = recording_fit.model();
  const Eigen::VectorXd scanned = starting_point(recording_fit);
  std::map<std::string, double> values;
  for (const ParameterEstimate& p :
       estimate_by_filter(model.settings(), recording_fit, recording_fit.recording().training()).parameters)
    values[p.name] = p.mean;
  const Eigen::VectorXd estimated = model.parameters().coordinates(values, model.parameters().prior_mean());
  return recording_fit.cost_in_full(estimated) < recording_fit.cost_in_full(scanned) ? estimated : scanned;
}

FittedModel fit_model(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording) {
  auto recording_fit = std::make_unique<RecordingFit>(settings, mesh, recording);
  const Model& model = recording_fit->model();
  const Eigen::VectorXd start =
      why_not_hyper_reduced(model).empty() ? starting_point_of_finite(*recording_fit) : starting_point(*recording_fit);
  return fit_recording(std::move(recording_fit), start, kBaseSpread);
}

// Returns the refit's model, run in full where that was not worth it before. It has the priors of the refit: those around
// its fit would hold it to what it was while something else was missing.
FittedModel extended(const FittedModel& base, const Refit& refit) {
  if (refit.model) return std::move(*refit.model);
  auto recording_fit = std::make_unique<RecordingFit>(
      extend_model(base.recording_fit->model().settings(), {refit.proposed}), *base.recording_fit);
  const Model& model = recording_fit->model();
  return fit_recording(std::move(recording_fit),
                       model.parameters().coordinates(refit.parameters, model.parameters().prior_mean()), kAddedSpread);
}

// Returns null where the effect was not refitted.
template <typename F>
auto refit_of(F& finding, const std::string& effect) -> decltype(finding.refits.data()) {
  const auto same = [&effect](const Refit& refit) { return refit.effect == effect; };
  const auto at = std::find_if(finding.refits.begin(), finding.refits.end(), same);
  return at == finding.refits.end() ? nullptr : &*at;
}

// Returns whether all that `next` has beyond the model acts on the body or in a sensor, and leaves the body's own mass and
// stiffness alone.
bool same_body(const Model& model, const Model& next) {
  return std::all_of(next.parts().begin(), next.parts().end(), [&model](const Model::Part& part) {
    const auto same = [&part](const Model::Part& known) { return known.label == part.label; };
    const LinearTerms& terms = part.terms;
    return std::any_of(model.parts().begin(), model.parts().end(), same) ||
           (terms.mass.empty() && terms.stiffness.empty() && terms.strain_stiffness.empty() && !adds_extra_force(part));
  });
}

// Returns zero for a linear model, whose estimator finds this out and corrects E.
Eigen::MatrixXd mesh_discrepancy_of_nonlinear(const FittedModel& fitted, const Recording& recording) {
  const Model& model = fitted.recording_fit->model();
  const Eigen::VectorXd& w = fitted.fit.w;
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(w.size(), w.size());
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
    model_ = fit_model(settings, mesh, recording_);
    describe_residual(model_, out_);
    options_.progress("compare the given model with the recording", 0, 0);
    add_step(compared_residual(model_), 0.0);
    bool moved = false;
    finding_ = examine(model_, {}, moved, [&](std::vector<MissingEffect> candidates) {
      out_.candidates = std::move(candidates);
      publish();
    });
    if (moved) {
      replace_step();
      describe_residual(model_, out_);
    }
    if (finding_.verdict == Verdict::unexplained) grow();
    out_.verdict = out_.final_verdict = finding_.verdict;
    out_.adequate = finding_.comparison.given().probability;
    out_.none_of_these = finding_.comparison.none_of_these();
    out_.z = finding_.comparison.given().z;
    out_.set = finding_.set;
    out_.best = best_explanation(model_, grown_ ? *grown_ : finding_);
    if (grown_) out_.best.effects.insert(out_.best.effects.begin(), finding_.set.front());
    out_.candidates = finding_.effects;
    out_.next_experiment = next_experiment(finding_.set);
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

  // Returns what a round on a model with one more effect takes over.
  PreviousRound after_adding(const Library& library) const {
    return {finding_.previous.finer, finding_.models, library, true};
  }

  // Returns the library of tangents that a round on `next` may take over.
  Library library_for(const FittedModel& next) const {
    return same_body(model_.recording_fit->model(), next.recording_fit->model()) ? finding_.previous.library : Library();
  }

  // Repeats rounds until the model fits nowhere better. `moved` says that it does not stay where it was.
  Finding examine(
      FittedModel& model, const PreviousRound& previous, bool& moved,
      const CandidatesSoFar& so_far = [](std::vector<MissingEffect>) {}) {
    const int most = previous.beside_another ? 1 : kMostBases;
    Finding out = diagnose_once(model, {}, options_, previous, so_far);
    moved = out.base_moved;
    for (int k = 1; out.to_repeat; ++k) {
      PreviousRound next = out.previous;
      next.settled = k == most;
      out = diagnose_once(model, {}, options_, next, so_far);
      moved = true;
    }
    return out;
  }

  /// A leader is a refit that is taken for one of several missing effects, with what is found beside it.
  struct Leader {
    std::string effect;
    Finding deeper;
  };

  // Several effects may be missing, of which none explains the error alone. Each leader in turn that explains a part of it
  // is taken for one of them. What is found beside it is compared with the rest.
  void grow() {
    const double cost = model_.rows.error.squaredNorm(), structured = structured_squares(model_.rows);
    std::vector<Leader> leaders;
    for (std::size_t i = 0; i < std::min(kGrown, finding_.refits.size()) && finding_.verdict != Verdict::missing; ++i) {
      if (cost - finding_.refits[i].cost > kComparison.promising * structured)
        examine_beside(finding_.refits[i], {}, leaders);
    }
    if (finding_.verdict != Verdict::missing) turn(leaders);
    if (finding_.verdict != Verdict::missing) return;
    exchange(leaders);
    const std::string best = finding_.comparison.best().effects.front();
    const auto is_best = [&best](const auto& x) { return x.effect == best; };
    const auto leader = std::find_if(leaders.begin(), leaders.end(), is_best);
    const auto refit = std::find_if(finding_.refits.begin(), finding_.refits.end(), is_best);
    std::rotate(finding_.refits.begin(), refit, refit + 1);
    if (leader == leaders.end()) return;  // one effect suffices with the noise that is known now
    finding_.take_over(best, leader->deeper.effects);
    finding_.believe(Comparison(finding_.comparison));
    grown_ = std::move(leader->deeper);
  }

  // The leader of a pair was fitted while the other effect was missing, which may have led it astray. So the pair that fits
  // best is fitted the other way round: all variants of its leader are tried beside the other effect, unless that one led,
  // too.
  void turn(std::vector<Leader>& leaders) {
    const auto cost = [](const Leader& l) { return l.deeper.refits.empty() ? no_rival : l.deeper.refits.front().cost; };
    const auto best = std::min_element(leaders.begin(), leaders.end(),
                                       [&](const Leader& a, const Leader& b) { return cost(a) < cost(b); });
    if (best == leaders.end() || best->deeper.refits.empty()) return;
    lead_in_turn(best->deeper.refits.front(), {best->effect}, leaders);
  }

  // What else may be missing hides the difference between effects. So all of them are tried in the place of the best pair's
  // leader, beside its other effect, unless that one led, too.
  void exchange(std::vector<Leader>& leaders) {
    const std::vector<std::string> pair = finding_.comparison.best().effects;
    const auto is = [](const std::string& name) { return [name](const auto& x) { return x.effect == name; }; };
    if (pair.size() < 2) return;
    const Leader& first = *std::find_if(leaders.begin(), leaders.end(), is(pair[0]));
    if (const Refit* const second = refit_of(first.deeper, pair[1])) lead_in_turn(*second, {}, leaders);
  }

  // Lets the second effect of a pair lead, as it was fitted beside the first one, unless it led already.
  void lead_in_turn(const Refit& second, const std::vector<std::string>& wanted, std::vector<Leader>& leaders) {
    const auto is_second = [&](const Leader& l) { return l.effect == second.effect; };
    Refit* const refit = refit_of(finding_, second.effect);
    if (refit == nullptr || std::any_of(leaders.begin(), leaders.end(), is_second)) return;
    refit->proposed = second.proposed;
    refit->entry = second.entry;
    refit->parameters = second.parameters;
    refit->model.reset();
    examine_beside(*refit, wanted, leaders);
  }

  // Compares what is missing beside a leader, or how the `wanted` effects fit beside it, with all that is known.
  void examine_beside(Refit& leader, const std::vector<std::string>& wanted, std::vector<Leader>& leaders) {
    options_.progress("what is missing beside " + leader.effect, 0, 0);
    std::shared_ptr<FittedModel> next;
    Finding deeper;
    const auto examine_rest = [&] {
      next = std::make_shared<FittedModel>(extended(model_, leader));
      const PreviousRound previous = after_adding(library_for(*next));
      bool moved = false;
      deeper = wanted.empty() ? examine(*next, previous, moved) : diagnose_once(*next, wanted, options_, previous);
    };
    if (!try_run(recording_, examine_rest)) return;
    leader.model = next;
    if (deeper.models->noise_variance() < finding_.models->noise_variance()) finding_.models = deeper.models;
    Comparison all = finding_.comparison;
    all.merge({leader.effect}, deeper.comparison);
    all.assess(*finding_.models);
    finding_.believe(std::move(all));
    leaders.push_back({leader.effect, std::move(deeper)});
  }

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
      finding_ = grown_ ? std::move(*grown_) : examine(model_, after_adding(library), moved);
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
    Library library = library_for(next);
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
