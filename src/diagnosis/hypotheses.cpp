#include "diagnosis/hypotheses.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "diagnosis/missing_force.hpp"
#include "diagnosis/scores.hpp"

namespace tissue_stiffness {
namespace {

void find_probabilities_of(std::vector<Hypothesis>& hypotheses) {
  double most = -std::numeric_limits<double>::infinity(), sum = 0.0;
  for (const Hypothesis& h : hypotheses) most = std::max(most, h.log_weight);
  for (Hypothesis& h : hypotheses) sum += h.probability = std::exp(h.log_weight - most);
  for (Hypothesis& h : hypotheses) h.probability /= sum;
}

double gain_over(const Hypothesis& model, const Hypothesis& extension) {
  return believed_gain(extension.log_evidence - model.log_weight + model.log_prior,
                       (extension.log_modal_evidence - model.log_modal_evidence).minCoeff(), model.test.z);
}

// Gives each hypothesis the evidence that is believed beside all that it extends, the smallest models first.
void weigh_extensions(std::vector<Hypothesis>& hypotheses) {
  std::vector<Hypothesis*> order;
  order.reserve(hypotheses.size());
  for (Hypothesis& h : hypotheses) order.push_back(&h);
  std::stable_sort(order.begin(), order.end(), [](const Hypothesis* a, const Hypothesis* b) {
    return std::make_pair(a->effects.size(), a->random_force != nullptr) <
           std::make_pair(b->effects.size(), b->random_force != nullptr);
  });
  for (Hypothesis* h : order) {
    double evidence = h->log_evidence;
    for (const Hypothesis& model : hypotheses) {
      if (h->extends(model)) evidence = std::min(evidence, model.log_weight - model.log_prior + gain_over(model, *h));
    }
    h->log_weight = evidence + h->log_prior;
  }
}

// Something unknown is one alternative to the most probable model, whatever it acts beside. So all random forces together
// gain over that model what its test says, and a search that tries more models makes them no more probable. Over a named
// model they gain what the one beside it does, if any size of the mesh's error says more. A force may also act in the place
// of what is named, whose model is a near twin then. So it keeps its prior where that model leaves nothing.
void bound_random_forces(const Hypothesis& best, std::vector<Hypothesis>& all) {
  const auto counts = [&best](const Hypothesis& h) {
    return h.random_force && (!h.superfluous || (h.same_effects(best) && !best.effects.empty()));
  };
  double gain = log_bayes_factor_of_test(best.test.z);
  for (const Hypothesis& h : all) {
    if (!h.random_force || !h.same_effects(best) || best.effects.empty()) continue;
    gain = std::max(gain, (h.log_modal_evidence - best.log_modal_evidence).maxCoeff());
  }
  const auto shown = [over_best = best.log_weight + gain](const Hypothesis& h) { return over_best + h.log_prior_of_force; };
  double sum = 0.0;
  for (Hypothesis& h : all) {
    if (!counts(h)) continue;
    h.log_weight = h.same_effects(best) ? shown(h) : std::min(h.log_weight, shown(h));
    sum += std::exp(h.log_weight - shown(h));
  }
  for (Hypothesis& h : all) {
    if (counts(h) && sum > 1.0) h.log_weight -= std::log(sum);
  }
}

}  // namespace

bool Hypothesis::holds(const std::string& effect) const {
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

bool Hypothesis::same_effects(const Hypothesis& other) const {
  return std::is_permutation(effects.begin(), effects.end(), other.effects.begin(), other.effects.end());
}

bool Hypothesis::extends(const Hypothesis& other) const {
  const bool all = std::all_of(other.effects.begin(), other.effects.end(), [this](const auto& e) { return holds(e); });
  return all && !other.random_force && (effects.size() > other.effects.size() || random_force);
}

bool Hypothesis::superfluous_beside(const Hypothesis& other) const {
  if (!extends(other) || other.test.structured()) return false;
  return random_force || log_weight - other.log_weight <= 2.0 * kComparison.worthwhile;
}

void Hypothesis::weigh(const Assessment& assessment, const ModelComparison& models) {
  log_evidence = assessment.log_evidence;
  log_modal_evidence = assessment.log_modal_evidence;
  test = assessment.test;
  if (!random_force) return;
  const Eigen::VectorXd gain = log_evidence_gained(*random_force, assessment, models);
  log_evidence += gain.maxCoeff();
  log_modal_evidence += gain;
}

const Hypothesis& Comparison::best() const {
  return *std::max_element(hypotheses.begin(), hypotheses.end(),
                           [](const Hypothesis& a, const Hypothesis& b) { return a.probability < b.probability; });
}

double Comparison::none_of_these() const {
  double sum = 0.0;
  for (const Hypothesis& h : hypotheses) sum += h.random_force ? h.probability : 0.0;
  return sum;
}

double Comparison::probability_of(const std::string& effect) const {
  double sum = 0.0;
  for (const Hypothesis& h : hypotheses) sum += h.holds(effect) && !h.random_force ? h.probability : 0.0;
  return sum;
}

std::vector<Trace> Comparison::traces() const {
  const Hypothesis& plain = best();
  std::vector<Hypothesis> weighed{plain};
  std::vector<Trace> out;
  for (const Hypothesis& h : hypotheses) {
    if (h.random_force || !h.superfluous_beside(plain)) continue;
    out.push_back({&h, 0.0});
    weighed.push_back(h);
  }
  for (Hypothesis& h : weighed) h.log_weight = h.log_evidence + h.log_prior;
  find_probabilities_of(weighed);
  const double sum = 1.0 - weighed.front().probability, together = std::min(sum, kComparison.most_traces);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].share = sum > 0.0 ? together * weighed[i + 1].probability / sum : 0.0;
  return out;
}

void Comparison::find_probabilities() {
  weigh_extensions(hypotheses);
  for (Hypothesis& h : hypotheses) {
    const auto enough = [&h](const Hypothesis& other) { return h.superfluous_beside(other); };
    h.superfluous = std::any_of(hypotheses.begin(), hypotheses.end(), enough);
  }
  std::vector<Hypothesis> weighed = hypotheses;
  for (Hypothesis& h : weighed) {
    if (h.superfluous) h.log_weight = -std::numeric_limits<double>::infinity();
  }
  const Hypothesis* best = &weighed.front();
  for (const Hypothesis& h : weighed) {
    if (!h.random_force && h.log_weight > best->log_weight) best = &h;
  }
  bound_random_forces(*best, weighed);
  find_probabilities_of(weighed);
  for (std::size_t i = 0; i < weighed.size(); ++i) hypotheses[i].probability = weighed[i].probability;
}

void Comparison::assess(const ModelComparison& models) {
  tbb::parallel_for(std::size_t{0}, hypotheses.size(), [&](std::size_t i) {
    const Assessment assessment = models.assess(*hypotheses[i].explained);
    hypotheses[i].weigh(assessment, models);
  });
  drop_worse_twins();
  find_probabilities();
}

void Comparison::drop_worse_twins() {
  const auto weight = [](const Hypothesis& h) { return h.log_evidence + h.log_prior; };
  const auto worse = [this, weight](const Hypothesis& h) {
    return std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& other) {
      const bool twin = h.same_effects(other) && !h.random_force == !other.random_force;
      return twin && (weight(other) > weight(h) || (weight(other) == weight(h) && &other < &h));
    });
  };
  std::vector<Hypothesis> kept;
  for (const Hypothesis& h : hypotheses) {
    if (!worse(h)) kept.push_back(h);
  }
  hypotheses = std::move(kept);
}

void Comparison::merge(const std::vector<std::string>& effects, const Comparison& deeper) {
  const auto same = [&](const Hypothesis& h) { return h.effects == effects; };
  const double prior = std::find_if(hypotheses.begin(), hypotheses.end(), same)->log_prior;
  hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(), same), hypotheses.end());
  for (Hypothesis h : deeper.hypotheses) {
    h.effects.insert(h.effects.begin(), effects.begin(), effects.end());
    h.log_prior += prior;
    hypotheses.push_back(std::move(h));
  }
}

Verdict judge(const Comparison& c) {
  const Hypothesis& given = c.given();
  if (given.probability > 1.0 - kComparison.believed)
    return given.test.passes() ? (c.passes_without_mesh ? Verdict::adequate : Verdict::numerics) : Verdict::unexplained;
  const Hypothesis& best = c.best();
  const bool named = !best.effects.empty() && !best.random_force && c.none_of_these() < kComparison.most_unknown;
  return named && best.test.passes() ? Verdict::missing : Verdict::unexplained;
}

std::vector<Hypothesis> named_hypotheses(const Comparison& comparison) {
  std::vector<Hypothesis> named;
  for (const Hypothesis& h : comparison.hypotheses) {
    if (!h.effects.empty() && !h.superfluous) named.push_back(h);
  }
  find_probabilities_of(named);
  std::stable_sort(named.begin(), named.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.probability > b.probability; });
  return named;
}

std::vector<std::string> believed_effects(const Comparison& comparison) {
  std::vector<std::string> out;
  double held = 0.0;
  for (const Hypothesis& h : named_hypotheses(comparison)) {
    if (held > kComparison.believed) break;
    held += h.probability;
    for (const std::string& effect : h.effects) {
      if (std::find(out.begin(), out.end(), effect) == out.end()) out.push_back(effect);
    }
  }
  return out;
}

}  // namespace tissue_stiffness
