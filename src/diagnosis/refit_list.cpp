#include "tissue_stiffness/diagnosis/refit_list.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>
#include <utility>

#include "tissue_stiffness/effects/registry.hpp"
#include "tissue_stiffness/forward/for_each_index.hpp"
#include "tissue_stiffness/settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tissue_stiffness/types/stop_request.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kRivals = 3;   // that are fitted on the finer mesh
constexpr double kFinerMesh = 0.25;  // of a mesh's error that one of half its size has left, at second order
constexpr double kReach = 1.05;      // times the best cost so far: fewer parameters may make up for less than that

std::string names_of(const std::vector<Addition>& additions) {
  std::string names;
  for (const Addition& a : additions) names += (names.empty() ? "" : " and ") + a.way->effect;
  return names;
}

}  // namespace

std::ptrdiff_t parameters_of(const std::vector<Addition>& additions) {
  ModelSettings alone;
  for (const Addition& a : additions) add_effect(alone, a.way->proposal.refine);
  std::ptrdiff_t count = 0;
  for (const EffectSettings& effect : alone.effects) {
    const std::vector<Quantity> quantities = read_parameters(effect);
    count += std::count_if(quantities.begin(), quantities.end(), [](const Quantity& q) { return q.estimated(); });
  }
  return count;
}

MisfitTest RefitList::test(const Refit& refit) const {
  return comparison_.test(refit.explained);
}

double RefitList::log_evidence_of_base() const {
  return comparison_.log_evidence(base_);
}

double RefitList::log_evidence(const Refit& refit) const {
  return comparison_.log_evidence(refit.explained);
}

void RefitList::try_each(std::size_t count, const std::function<std::string(std::size_t)>& name,
                         const std::function<void(std::size_t)>& work) const {
  std::mutex telling;
  std::size_t over = 0;
  const auto& checkpoint = look_.base.study->recording().checkpoint;
  const auto try_one = [&](std::size_t i) {
    checkpoint();
    {
      const std::lock_guard<std::mutex> lock(telling);
      options_.progress(name(i), over, count);
    }
    try {
      work(i);
    } catch (const NumericalError&) {
      // A study that was ended; otherwise a model that cannot be run explains nothing.
      checkpoint();
    }
    const std::lock_guard<std::mutex> lock(telling);
    ++over;
  };
  for_each_index(count, try_one, tbb::simple_partitioner());
}

void RefitList::add(std::vector<std::vector<Addition>> list) {
  double rival = no_rival;
  for (const Refit& r : refits_) {
    if (r.way->linear) rival = std::min(rival, kReach * r.fitted);
  }
  // The longest fits first: the last one to end keeps one core busy only.
  std::vector<std::pair<std::ptrdiff_t, std::vector<Addition>>> trials;
  for (std::vector<Addition>& additions : list) trials.emplace_back(parameters_of(additions), std::move(additions));
  std::stable_sort(trials.begin(), trials.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::optional<Refit>> done(trials.size());
  try {
    try_each(
        trials.size(), [&](std::size_t i) { return "refit with " + names_of(trials[i].second); },
        [&](std::size_t i) { done[i] = refit(look_.base, trials[i].second, rival); });
  } catch (const Interrupted&) {
    keep(std::move(done));
    throw;
  }
  keep(std::move(done));
}

void RefitList::keep(std::vector<std::optional<Refit>> done) {
  for (std::optional<Refit>& refit : done) {
    if (!refit) continue;
    comparison_.note(refit->explained.error);
    refits_.push_back(std::move(*refit));
  }
  sort();
  for (std::size_t i = 1; i < refits_.size(); ++i) refits_[i].model.reset();
  so_far_(refits_);
}

void RefitList::compare_on_finer_mesh() {
  const Study* finer = look_.finer.study.get();
  if (finer == nullptr || empty() || !comparison_.test(base_).passes()) return;
  if (comparison_.test_of(look_.base.rows.error, static_cast<double>(look_.base.fit.w.size())).passes()) return;
  const double given = log_evidence_of_base();
  // What gains more than the mesh's change does not imitate it.
  if (log_evidence(best()) - given > 0.5 * look_.by_mesh / comparison_.noise_variance()) return;
  std::vector<Refit*> rivals;
  for (Refit& refit : refits_) {
    if (log_evidence(refit) > given && refit.way->linear && rivals.size() < kRivals) rivals.push_back(&refit);
  }
  if (rivals.empty()) return;
  const Study& study = *look_.base.study;
  const ModelSettings& settings = study.model().settings();
  base_ = explain(fit_on_finer_mesh(*finer, settings, study.model().values(look_.base.fit.w)));
  comparison_ = ModelComparison(look_.base, kFinerMesh * look_.finer.change);
  try_each(
      rivals.size(), [&](std::size_t i) { return "on a finer mesh: " + rivals[i]->effects.front(); },
      [&](std::size_t i) {
        Refit& refit = *rivals[i];
        refit.explained = explain(fit_on_finer_mesh(*finer, extend_model(settings, refit.proposals), refit.parameters));
      });
  for (const Refit* refit : rivals) comparison_.note(refit->explained.error);
  sort();
}

void RefitList::sort() {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < refits_.size(); ++i) order.emplace_back(-log_evidence(refits_[i]), i);
  std::stable_sort(order.begin(), order.end());
  std::vector<Refit> sorted;
  for (const auto& [evidence, i] : order) sorted.push_back(std::move(refits_[i]));
  refits_ = std::move(sorted);
  drop_worse_ways();
}

// One refit an effect, the best.
void RefitList::drop_worse_ways() {
  for (auto refit = refits_.begin(); refit != refits_.end();) {
    const bool known = std::any_of(refits_.begin(), refit, [&](const Refit& r) { return r.effects == refit->effects; });
    refit = known ? refits_.erase(refit) : refit + 1;
  }
}

}  // namespace tissue_stiffness
