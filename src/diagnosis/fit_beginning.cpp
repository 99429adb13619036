#include <algorithm>
#include <cmath>

#include "tissue_stiffness/diagnosis/ranking.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kMostStarts = 2;
// Prior standard deviations of an amplitude that is tried: of a positive one, whose prior speaks of a strong effect, and of
// a signed one.
constexpr double kPositive[] = {-3.0, -2.25, -1.5, -0.75, 0.0, 0.75, 1.5}, kSigned[] = {-1.0, -0.3, 0.3, 1.0};

// The proposal's prior with the base's fit, at several strengths.
std::vector<Eigen::VectorXd> strengths(const Study& study, const Eigen::VectorXd& w, const Candidate& way) {
  std::vector<Eigen::VectorXd> out{w};
  const auto& free = study.model().free_parameters();
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i].name.rfind(way.effect + "." + way.proposal.amplitude, 0) != 0) continue;
    const auto try_at = [&](double deviations) {
      const auto k = static_cast<Eigen::Index>(i);
      Eigen::VectorXd there = w;
      there[k] += deviations * study.model().prior_std()[k];
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

BeginningFit fit_beginning(const Fitted& base, const Candidate& way) {
  const Study& known = *base.study;
  ModelSettings settings = known.model().settings();
  add_effect(settings, way.proposal.refine);
  const Study study(settings, known);
  const Model& model = study.model();
  const Eigen::VectorXd w = study.extend(known, base.fit.w);
  const std::vector<Eigen::Index> tuning = study.tuning_shared_with(known);
  const Eigen::VectorXd spread = study.spread_beyond(known);
  std::vector<Study::Place> places;
  for (const Eigen::VectorXd& start : strengths(study, w, way))
    places.push_back(study.scan_near(start, tuning, kBeginning));
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  places.resize(std::min(places.size(), kMostStarts));
  BatchFit fit;
  for (const Study::Place& place : places) {
    BatchFit now = study.quick_fit(place.w, spread, kBeginning);
    if (fit.w.size() == 0 || now.cost < fit.cost) fit = std::move(now);
  }
  BeginningFit out;
  const auto added = static_cast<double>(model.free_parameters().size() - known.model().free_parameters().size());
  out.deviance = fit.cost + added * std::log(kBeginning * base.rows.count());
  out.parameters = model.values(fit.w);
  return out;
}

}  // namespace tissue_stiffness
