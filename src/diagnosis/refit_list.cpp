#include "diagnosis/refit_list.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>
#include <utility>

#include "diagnosis/missing_force.hpp"
#include "diagnosis/scores.hpp"
#include "diagnosis/try_run.hpp"
#include "effects/registry.hpp"
#include "fit/nested_parameters.hpp"
#include "forward/for_each_index.hpp"
#include "types/stop_request.hpp"

namespace tissue_stiffness {

std::ptrdiff_t parameters_of(const Candidate& candidate) {
  const std::vector<Quantity> quantities = read_parameters(to_settings(candidate.proposal.refine));
  return std::count_if(quantities.begin(), quantities.end(), [](const Quantity& q) { return q.estimated(); });
}

void RefitList::try_each(std::size_t count, const std::function<std::string(std::size_t)>& name,
                         const std::function<void(std::size_t)>& work) {
  std::mutex telling;
  std::size_t over = 0;
  const Recording& recording = screening_.base.recording_fit->recording();
  const auto try_one = [&](std::size_t i) {
    recording.checkpoint();
    {
      const std::lock_guard<std::mutex> lock(telling);
      options_.progress(name(i), over, count);
    }
    std::string reason;
    const bool run = try_run(
        recording, [&] { work(i); }, &reason);
    const std::lock_guard<std::mutex> lock(telling);
    if (!run) failure_ = reason;
    ++over;
  };
  for_each_index(count, try_one, tbb::simple_partitioner());
}

void RefitList::add(std::vector<RefitTask> list, double least_gain) {
  RefitLimits limits{kReach * screening_.rival, least_gain, given_.strict_test.passes(), base_->steps};
  for (const Refit& r : refits_) {
    if (!r.candidate->linear) continue;
    limits.rival = std::min(limits.rival, kReach * r.fitted);
    limits.steps_rival = std::min(limits.steps_rival, kReach * r.explained->steps.cost);
  }
  // The longest fits go first, because the last one to end keeps only one core busy.
  std::vector<std::pair<std::pair<bool, std::ptrdiff_t>, RefitTask>> trials;
  for (RefitTask& task : list) {
    const Candidate& candidate = *task.candidate;
    trials.emplace_back(std::make_pair(!candidate.linear, parameters_of(candidate)), std::move(task));
  }
  std::stable_sort(trials.begin(), trials.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::optional<Refit>> done(trials.size());
  try {
    try_each(
        trials.size(), [&](std::size_t i) { return "refit with " + trials[i].second.effect(); },
        [&](std::size_t i) { done[i] = refit_with(screening_.base, trials[i].second, limits); });
  } catch (const Interrupted&) {
    keep(std::move(done));
    throw;
  }
  keep(std::move(done));
}

void RefitList::keep(std::vector<std::optional<Refit>> done) {
  for (std::optional<Refit>& refit : done) {
    if (!refit) continue;
    comparison_.note(refit->explained->error);
    if (refit->model && refit->model->recording_fit->model().nonlinear() && screening_.finer.recording_fit)
      test_by_own_mesh(finer_mesh(*refit->model, screening_.finer.recording_fit.get()), *refit);
    refits_.push_back(std::move(*refit));
  }
  assess();
  for (std::size_t i = 1; i < refits_.size(); ++i) refits_[i].model.reset();
  so_far_(*this);
}

double RefitList::variants_of(const std::string& effect) const {
  const auto same = [&](const Candidate& c) { return c.effect == effect; };
  return static_cast<double>(std::count_if(screening_.candidates.begin(), screening_.candidates.end(), same));
}

// Beforehand the given model is as probable as all effects together. All effects are alike, however many variants each has.
// Something that the library does not have is as probable as one of them, and may act beside the best one, too.
const Comparison& RefitList::compare() {
  if (compared_) return *compared_;
  const double prior = -std::log(static_cast<double>(std::max<std::size_t>(1, screening_.effect_count)));
  compared_.emplace();
  std::vector<Hypothesis>& hypotheses = compared_->hypotheses;
  const auto add = [&](Hypothesis h, const Assessment& assessment) {
    h.weigh(assessment, comparison_);
    hypotheses.push_back(std::move(h));
  };
  const auto alone = [](std::vector<std::string> effects, double log_prior, std::shared_ptr<const Explained> explained) {
    Hypothesis h;
    h.effects = std::move(effects);
    h.log_prior = log_prior;
    h.explained = std::move(explained);
    return h;
  };
  const auto beside = [prior](Hypothesis h, std::shared_ptr<const RandomForce> force) {
    h.random_force = std::move(force);
    h.log_prior += h.log_prior_of_force = prior;
    return h;
  };
  add(alone({}, 0.0, base_), given_);
  for (const Refit& refit : refits_)
    add(alone({refit.effect}, prior - std::log(variants_of(refit.effect)), refit.explained), refit.assessment);
  if (!base_force_) base_force_ = std::make_shared<const RandomForce>(screening_.base);
  add(beside(hypotheses[0], base_force_), given_);
  if (!empty() && best().model) {
    add(beside(hypotheses[1], std::make_shared<const RandomForce>(*best().model)), best().assessment);
  }
  compared_->passes_without_mesh = passes_without_mesh();
  compared_->find_probabilities();
  return *compared_;
}

bool RefitList::passes_without_mesh() const {
  const FittedModel& base = screening_.base;
  return comparison_.test_of(base.rows.error, static_cast<double>(base.fit.w.size())).passes();
}

bool RefitList::move_to_better_base() {
  const RecordingFit& recording_fit = *screening_.base.recording_fit;
  if (recording_fit.model().nonlinear()) return false;
  const NestedParameters own(recording_fit, recording_fit);
  RecordingFit::Place start = recording_fit.scan_near(screening_.base.fit.w, own.scanned());
  for (const Refit& refit : refits_) {
    RecordingFit::Place place = recording_fit.scan_near(
        recording_fit.model().parameters().coordinates(refit.parameters, screening_.base.fit.w), {});
    if (place.cost < start.cost) start = std::move(place);
  }
  const BatchFit fit = recording_fit.quick_fit(start.w, own.spread());
  if (!(screening_.base.fit.cost - fit.cost > 2.0 * kComparison.worthwhile * comparison_.noise_variance())) return false;
  base_moved_ = true;
  screening_.move_base(fit, comparison_);
  base_ = std::make_shared<const Explained>(screening_.explained);
  base_force_.reset();
  comparison_.note(base_->error);
  assess();
  return true;
}

void RefitList::test_best_by_own_numerics() {
  if (compare().best().effects.empty() || !best().model || !screening_.finer.recording_fit) return;
  Refit& refit = refits_.front();
  choose_basis_at_fit(screening_.base, base_->steps, refit);
  const FinerMesh finer = finer_mesh(*refit.model, screening_.finer.recording_fit.get());
  if (!finer.recording_fit) return;
  test_by_own_mesh(finer, refit);
  assess();
}

void RefitList::test_by_own_mesh(const FinerMesh& finer, Refit& refit) {
  Explained own = *refit.explained;
  own.mesh = std::make_shared<const MeshAllowance>(comparison_.allowance(mesh_change(*refit.model, finer)));
  refit.explained = std::make_shared<const Explained>(std::move(own));
}

// Assesses all models anew, because the noise is that of the model that leaves least.
void RefitList::assess() {
  compared_.reset();
  given_ = comparison_.assess(*base_);
  tbb::parallel_for(std::size_t{0}, refits_.size(), [&](std::size_t i) {
    Refit& refit = refits_[i];
    refit.assessment = comparison_.assess(*refit.explained);
    const Assessment& larger = refit.assessment;
    refit.log_bayes_factor =
        believed_gain(larger.log_evidence - given_.log_evidence,
                      (larger.log_modal_evidence - given_.log_modal_evidence).minCoeff(), given_.test.z) -
        std::log(variants_of(refit.effect));
  });
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < refits_.size(); ++i) order.emplace_back(-refits_[i].log_bayes_factor, i);
  std::stable_sort(order.begin(), order.end());
  std::vector<Refit> sorted;
  sorted.reserve(order.size());
  for (const auto& [evidence, i] : order) sorted.push_back(std::move(refits_[i]));
  refits_ = std::move(sorted);
  drop_worse_variants();
}

// Keeps one refit for each effect, the best.
void RefitList::drop_worse_variants() {
  for (auto refit = refits_.begin(); refit != refits_.end();) {
    const bool known = std::any_of(refits_.begin(), refit, [&](const Refit& r) { return r.effect == refit->effect; });
    refit = known ? refits_.erase(refit) : refit + 1;
  }
}

}  // namespace tissue_stiffness
