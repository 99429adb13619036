#include <algorithm>
#include <cmath>

#include "diagnosis/refit.hpp"
#include "settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kMostStarts = 2;
// An amplitude is tried at these prior standard deviations: a positive one, whose prior speaks of a strong effect, and a
// signed one.
constexpr double kPositive[] = {-3.0, -2.25, -1.5, -0.75, 0.0, 0.75, 1.5}, kSigned[] = {-1.0, -0.3, 0.3, 1.0};

// Returns starts from the base's fit and the proposal's prior, at several strengths.
std::vector<Eigen::VectorXd> strengths(const RecordingFit& recording_fit, const Eigen::VectorXd& w,
                                       const Candidate& candidate) {
  std::vector<Eigen::VectorXd> out{w};
  const auto& free = recording_fit.model().parameters().free();
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i].name.rfind(candidate.effect + "." + candidate.proposal.amplitude, 0) != 0) continue;
    const auto try_at = [&](double deviations) {
      const auto k = static_cast<Eigen::Index>(i);
      Eigen::VectorXd there = w;
      there[k] += deviations * recording_fit.model().parameters().prior_std()[k];
      const double value = free[i].to_value(there[k]);
      if (free[i].lower < value && value < free[i].upper) out.push_back(std::move(there));
    };
    if (free[i].prior.kind == Quantity::Kind::log_normal) {
      std::for_each(std::begin(kPositive), std::end(kPositive), try_at);
    } else {
      std::for_each(std::begin(kSigned), std::end(kSigned), try_at);
    }
  }
  return out;
}

}  // namespace

RankedFit fit_initial_segment(const FittedModel& base, const Candidate& candidate) {
  const RecordingFit& known = *base.recording_fit;
  const RecordingFit recording_fit(extend_model(known.model().settings(), {candidate.proposal.refine}), known,
                                   ranking_basis());
  const Model& model = recording_fit.model();
  const Eigen::VectorXd w = recording_fit.extend(known, base.fit.w);
  const std::vector<Eigen::Index> tuning = recording_fit.scanned_shared_with(known);
  const std::vector<Eigen::Index> acting = recording_fit.acting_shared_with(known);
  const Eigen::VectorXd spread = recording_fit.spread_beyond(known);
  std::vector<RecordingFit::Place> places;
  for (const Eigen::VectorXd& start : strengths(recording_fit, w, candidate)) {
    const RecordingFit::Place loaded = recording_fit.project({start}, acting, kInitialSegment);
    const RecordingFit::Place tuned = recording_fit.scan_prior(loaded.w, tuning, kInitialSegment);
    places.push_back(recording_fit.project(tuned, acting, kInitialSegment));
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  places.resize(std::min(places.size(), kMostStarts));
  BatchFit fit;
  for (const RecordingFit::Place& place : places) {
    const Eigen::VectorXd near = recording_fit.scan_near(place.w, tuning, kInitialSegment).w;
    BatchFit now = recording_fit.quick_fit(near, spread, kInitialSegment);
    if (fit.w.size() == 0 || now.cost < fit.cost) fit = std::move(now);
  }
  RankedFit out;
  const auto added = static_cast<double>(model.parameters().free().size() - known.model().parameters().free().size());
  out.deviance = fit.cost + added * std::log(kInitialSegment * base.rows.count());
  out.parameters = model.parameters().values(fit.w);
  return out;
}

}  // namespace tissue_stiffness
