#include "diagnosis/initial_segment.hpp"

#include <algorithm>
#include <cmath>

#include "effects/registry.hpp"
#include "fit/nested_parameters.hpp"
#include "settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kMostPlaces = 2;
constexpr std::size_t kMostStarts = 7;  // that are scanned, of the starts of several candidates
constexpr int kRankingVectors = 12;     // for each effect, of models that only rank
// An amplitude is tried at its prior's mean and at these prior standard deviations beside it: a positive one, whose prior
// speaks of a strong effect, and a signed one.
constexpr double kPositive[] = {-3.0, -2.25, -1.5, -0.75, 0.75, 1.5}, kSigned[] = {-1.0, -0.3, 0.3, 1.0};

// Returns the parameters that say how strong the candidate is.
std::vector<Eigen::Index> amplitude_of(const Candidate& candidate, const RecordingFit& recording_fit,
                                       const RecordingFit& base) {
  std::vector<Eigen::Index> out;
  const auto& free = recording_fit.model().parameters().free();
  for (std::size_t i = 0; i < free.size(); ++i) {
    const bool added = base.index(free[i].name) < 0;
    if (added && candidate.has_amplitude(free[i].name)) out.push_back(static_cast<Eigen::Index>(i));
  }
  return out;
}

// Returns `w` with the added parameters where they start in another candidate.
Eigen::VectorXd started_like(const Candidate& other, const RecordingFit& recording_fit, const RecordingFit& base,
                             Eigen::VectorXd w) {
  const std::vector<Quantity> quantities = read_parameters(to_settings(other.proposal.with_given_shape()));
  const auto& free = recording_fit.model().parameters().free();
  auto next = quantities.begin();
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (base.index(free[i].name) >= 0) continue;
    next = std::find_if(next, quantities.end(), [](const Quantity& q) { return q.estimated(); });
    w[static_cast<Eigen::Index>(i)] = free[i].to_coordinate((next++)->value);
  }
  return w;
}

// Keeps the starts that fit best, with what acts `linear`ly solved for.
void keep_best(std::vector<Eigen::VectorXd>& starts, const RecordingFit& recording_fit,
               const std::vector<Eigen::Index>& linear) {
  const std::vector<double> costs = recording_fit.costs(starts, linear, kInitialSegment);
  std::vector<std::pair<double, std::size_t>> order;
  order.reserve(starts.size());
  for (std::size_t i = 0; i < starts.size(); ++i) order.emplace_back(costs[i], i);
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), kMostStarts));
  std::vector<Eigen::VectorXd> best;
  best.reserve(order.size());
  for (const auto& [cost, i] : order) best.push_back(std::move(starts[i]));
  starts = std::move(best);
}

// Returns starts from the base's fit and the proposal's prior, at several strengths.
std::vector<Eigen::VectorXd> strengths(const RecordingFit& recording_fit, const Eigen::VectorXd& w,
                                       const std::vector<Eigen::Index>& amplitude) {
  std::vector<Eigen::VectorXd> out{w};
  for (const Eigen::Index k : amplitude) {
    const FreeParameter& free = recording_fit.model().parameters().free()[static_cast<std::size_t>(k)];
    const auto try_at = [&](double deviations) {
      Eigen::VectorXd there = w;
      there[k] += deviations * recording_fit.model().parameters().prior_std()[k];
      const double value = free.to_value(there[k]);
      if (free.lower < value && value < free.upper) out.push_back(std::move(there));
    };
    if (free.prior.kind == Quantity::Kind::log_normal) {
      std::for_each(std::begin(kPositive), std::end(kPositive), try_at);
    } else {
      std::for_each(std::begin(kSigned), std::end(kSigned), try_at);
    }
  }
  return out;
}

// Returns the base with the candidate's proposal in a few vectors for each effect, which suffice to rank.
RecordingFit extended(const FittedModel& base, const Candidate& candidate) {
  BasisOptions basis;
  basis.per_part = basis.released = kRankingVectors;
  const RecordingFit& known = *base.recording_fit;
  return {extend_model(known.model().settings(), {candidate.proposal.with_given_shape()}), known, basis};
}

// Returns Schwarz's penalty for the parameters that the base does not have.
double penalty(const FittedModel& base, const RecordingFit& recording_fit) {
  const std::size_t all = recording_fit.model().parameters().free().size();
  const auto added = static_cast<double>(all - base.recording_fit->model().parameters().free().size());
  return added * std::log(kInitialSegment * base.rows.count());
}

}  // namespace

std::vector<RankedFit> scan_initial_segment(const FittedModel& base, const Candidate& candidate,
                                            const std::vector<const Candidate*>& others) {
  const RecordingFit& known = *base.recording_fit;
  const RecordingFit recording_fit = extended(base, candidate);
  const NestedParameters shared(recording_fit, known);
  const std::vector<Eigen::Index> tuning = shared.scanned();
  const double complexity = penalty(base, recording_fit);
  const Eigen::VectorXd known_place = shared.extend(base.fit.w);
  std::vector<Eigen::Index> linear = shared.acting(), amplitude = amplitude_of(candidate, recording_fit, known);
  std::vector<Eigen::VectorXd> starts{known_place};
  // Where the motion is linear in the strength, each point of the scan finds it by itself.
  if (std::none_of(amplitude.begin(), amplitude.end(), [&shared](Eigen::Index i) { return shared.tunes(i); })) {
    linear.insert(linear.end(), amplitude.begin(), amplitude.end());
  } else {
    starts = strengths(recording_fit, known_place, amplitude);
    for (const Candidate* other : others) {
      const Eigen::VectorXd start = started_like(*other, recording_fit, known, known_place);
      for (Eigen::VectorXd& w : strengths(recording_fit, start, amplitude)) starts.push_back(std::move(w));
    }
    if (!others.empty()) keep_best(starts, recording_fit, linear);
  }
  std::vector<RankedFit> out;
  for (const Eigen::VectorXd& start : starts) {
    const RecordingFit::Place place = recording_fit.scan_prior(start, tuning, linear, kInitialSegment);
    out.push_back({recording_fit.model().parameters().values(place.w), place.cost + complexity});
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.deviance < b.deviance; });
  out.resize(std::min(out.size(), kMostPlaces));
  return out;
}

RankedFit fit_initial_segment(const FittedModel& base, const Candidate& candidate,
                              const std::vector<std::map<std::string, double>>& starts, double rival) {
  const RecordingFit& known = *base.recording_fit;
  const RecordingFit recording_fit = extended(base, candidate);
  const ParameterSpace& parameters = recording_fit.model().parameters();
  const NestedParameters shared(recording_fit, known);
  const std::vector<Eigen::Index> tuning = shared.scanned();
  const Eigen::VectorXd spread = shared.spread();
  const double complexity = penalty(base, recording_fit);
  RankedFit out;
  for (const std::map<std::string, double>& start : starts) {
    const Eigen::VectorXd w = parameters.coordinates(start, parameters.prior_mean());
    const Eigen::VectorXd near = recording_fit.scan_near(w, tuning, kInitialSegment).w;
    const BatchFit fit = recording_fit.quick_fit(near, spread, kInitialSegment, std::min(rival, out.deviance) - complexity);
    if (fit.cost + complexity < out.deviance) out = {parameters.values(fit.w), fit.cost + complexity};
  }
  return out;
}

}  // namespace tissue_stiffness
