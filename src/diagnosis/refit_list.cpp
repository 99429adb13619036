#include "tissue_stiffness/diagnosis/refit_list.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>
#include <utility>

#include "tissue_stiffness/effects/registry.hpp"
#include "tissue_stiffness/forward/for_each_index.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tissue_stiffness/types/stop_request.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kMeshCounts = 0.2;  // rms of its error [sigma] from which leaders are compared on a finer one
constexpr std::size_t kLeaders = 4;  // that are
constexpr double kClose = 0.9;       // of what the best refit explains: as good, but for the numerics
constexpr double kReach = 1.05;      // times the best cost so far: fewer parameters may make up for less than that

std::string names_of(const std::vector<Addition>& additions) {
  std::string names;
  for (const Addition& a : additions) names += (names.empty() ? "" : " and ") + a.way->effect;
  return names;
}

}  // namespace

double evidence(const Refit& refit, double rows, double variance) {
  return -0.5 * refit.cost_beside_numerics / variance - 0.5 * refit.added_parameters * std::log(rows);
}

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

bool RefitList::holds(const std::string& effect) const {
  return std::any_of(refits_.begin(), refits_.end(), [&](const Refit& r) { return r.effects.front() == effect; });
}

bool RefitList::mesh_counts() const {
  return look_.floor > kMeshCounts;
}

bool RefitList::is_noise(double cost) const {
  return cost <= kExplained * kExplained * look_.unavoidable();
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
        [&](std::size_t i) { done[i] = refit(look_.base, trials[i].second, look_.finer.change, rival); });
  } catch (const Interrupted&) {
    keep(std::move(done));
    throw;
  }
  keep(std::move(done));
}

void RefitList::keep(std::vector<std::optional<Refit>> done) {
  for (std::optional<Refit>& refit : done) {
    if (refit) refits_.push_back(std::move(*refit));
  }
  sort();
  for (std::size_t i = 1; i < refits_.size(); ++i) refits_[i].model.reset();
  so_far_(refits_);
}

double RefitList::left_beside_steps() {
  if (!left_beside_steps_) left_beside_steps_ = cost_beside_steps(look_.base).cost;
  return *left_beside_steps_;
}

// Alone: nothing has to be missing beside them.
void RefitList::add_steps() {
  std::vector<std::vector<Addition>> list;
  for (const Ranked& r : look_.ranked) {
    if (r.best->of_simulation && !holds(r.effect)) list.push_back({{r.best, r.score.amplitude}});
  }
  add(list);
}

void RefitList::compare_beside_steps() {
  if (refits_.empty() || best().way->of_simulation || look_.base.study->model().nonlinear()) return;
  std::vector<Refit*> leaders;
  for (Refit& r : refits_) {
    const bool close = look_.cost - r.cost > kClose * (look_.cost - best().cost);
    if (r.way->linear && close && leaders.size() < kLeaders) leaders.push_back(&r);
  }
  std::vector<Refit*> todo;
  std::copy_if(leaders.begin(), leaders.end(), std::back_inserter(todo), [](const Refit* r) { return !r->beside_steps; });
  if ((leaders.size() < 2 && !leaves_more_than_noise()) || todo.empty()) return;
  if (left_beside_steps() < best().cost) return add_steps();
  for (Refit* r : todo) r->beside_steps.emplace();
  try_each(
      todo.size(), [&](std::size_t i) { return "beside time steps: " + todo[i]->effects.front(); },
      [&](std::size_t i) { *todo[i]->beside_steps = cost_beside_steps(look_.base, *todo[i], look_.finer.change); });
  if (std::any_of(leaders.begin(), leaders.end(), [&](const Refit* r) { return is_noise(r->beside_steps->cost); })) {
    for (Refit* r : leaders) r->allow_for_steps();
  }
  sort();
}

void RefitList::compare_on_finer_mesh() {
  if (refits_.size() < 2 || !mesh_counts()) return;
  std::vector<Refit*> leaders;
  for (Refit& r : refits_) {
    if (leaders.size() < kLeaders && r.way->linear) leaders.push_back(&r);
  }
  try_each(
      leaders.size(), [&](std::size_t i) { return "on a finer mesh: " + leaders[i]->effects.front(); },
      [&](std::size_t i) {  // a fit that ends in another minimum there speaks against nothing
        double& cost = leaders[i]->cost_beside_numerics;
        cost = std::min(cost, cost_on_finer_mesh(look_.base, *leaders[i], look_.finer.study.get()));
      });
  sort();
}

void RefitList::sort() {
  double lowest = look_.cost;
  for (const Refit& r : refits_) lowest = std::min(lowest, r.cost_beside_numerics);
  const double variance = std::max(1.0, lowest / look_.rows);
  std::stable_sort(refits_.begin(), refits_.end(), [&](const Refit& a, const Refit& b) {
    return evidence(a, look_.rows, variance) > evidence(b, look_.rows, variance);
  });
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
