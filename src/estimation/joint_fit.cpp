#include "estimation/joint_fit.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "fit/batch_fit.hpp"
#include "forward/study_model.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kInterval = 1.96;   // standard deviations
constexpr double kSpread = 2.0;      // posterior standard deviations, of the first sigma points
constexpr double kNarrowest = 1e-3;  // prior standard deviations

struct Normal {
  Eigen::VectorXd mean, std;
};

// Returns what an estimate says of the free parameters, in filter coordinates.
Normal coordinates(const Estimate& estimate, const std::vector<FreeParameter>& free) {
  const auto count = static_cast<Eigen::Index>(free.size());
  Normal out{Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const FreeParameter& parameter = free[static_cast<std::size_t>(i)];
    const ParameterEstimate& known = estimate.parameters[static_cast<std::size_t>(i)];
    const double low = parameter.to_coordinate(known.lower95), high = parameter.to_coordinate(known.upper95);
    out.mean[i] = 0.5 * (low + high);
    out.std[i] = std::clamp((high - low) / (2.0 * kInterval), kNarrowest * parameter.prior_std(), parameter.prior_std());
  }
  return out;
}

std::vector<std::string> names(const std::vector<BodyRecording>& recordings) {
  std::vector<std::string> out;
  for (const BodyRecording& given : recordings) out.push_back(given.name);
  return out;
}

std::vector<std::unique_ptr<RecordingFit>> fits(const std::vector<BodyRecording>& recordings) {
  std::vector<std::unique_ptr<RecordingFit>> out;
  for (const BodyRecording& given : recordings) {
    out.push_back(std::make_unique<RecordingFit>(given.settings, given.mesh, given.recording));
    if ((out.back()->model().parameters().drift().array() > 0.0).any())
      throw InputError(given.name, "a parameter that drifts", "constant ones, with several recordings");
  }
  return out;
}

std::vector<const Model*> models_of(const std::vector<std::unique_ptr<RecordingFit>>& fits) {
  std::vector<const Model*> out;
  for (const auto& fit : fits) out.push_back(&fit->model());
  return out;
}

}  // namespace

JointFit::JointFit(const std::vector<BodyRecording>& recordings, const std::vector<std::string>& own,
                   const JointProgress& progress)
    : recordings_(recordings),
      progress_(progress),
      sharing_{names(recordings), own},
      fits_(fits(recordings)),
      shared_(sharing_, models_of(fits_)),
      prior_(shared_.prior_std()),
      noise_(recordings.size(), 1.0),
      misfit_scales_(recordings.size(), 1.0),
      alone_(recordings.size()),
      filter_(shared_.prior_mean(), prior_.cwiseAbs2().asDiagonal()) {}

std::vector<const Model*> JointFit::models() const {
  return models_of(fits_);
}

bool JointFit::studied_in_full() const {
  return std::all_of(fits_.begin(), fits_.end(),
                     [](const auto& fit) { return tissue_stiffness::studied_in_full(fit->model()); });
}

std::vector<FitPart> JointFit::parts() const {
  std::vector<FitPart> out;
  for (std::size_t r = 0; r < fits_.size(); ++r) {
    if (!recordings_[r].predicted) out.push_back({fits_[r]->whole(), shared_.columns(r), std::max(1.0, misfit_scales_[r])});
  }
  return out;
}

double JointFit::cost(const Eigen::VectorXd& w) const {
  try {
    return free_fit(parts(), w).cost;
  } catch (const NumericalError&) {
    return std::numeric_limits<double>::infinity();
  }
}

void JointFit::estimate_alone(std::size_t r) {
  const BodyRecording& given = recordings_[r];
  progress_("estimate " + given.name + " alone", r, recordings_.size());
  Estimator estimator(given.settings, given.mesh);
  estimator.set_first_stamp(given.recording.first_stamp);
  for (const LoadSample& load : given.recording.loads) estimator.add_load(load);
  estimator.replay(given.recording.frames, nullptr, given.recording.checkpoint);
  alone_[r] = estimator.estimate();
  double square = 0.0, rows = 0.0;
  for (const Misfit& misfit : estimator.free_run()) {
    square += misfit.count * misfit.rms_sigma * misfit.rms_sigma;
    rows += misfit.count;
  }
  noise_[r] = std::max(1.0, square / std::max(1.0, rows));
}

void JointFit::run() {
  Eigen::VectorXd information = 1e-6 * prior_.cwiseAbs2().cwiseInverse(),
                  pull = information.cwiseProduct(shared_.prior_mean());
  std::vector<Eigen::VectorXd> alone;
  for (std::size_t r = 0; r < fits_.size(); ++r) {
    if (recordings_[r].predicted) continue;
    estimate_alone(r);
    const Normal own = coordinates(alone_[r], fits_[r]->model().parameters().free());
    alone.push_back(Eigen::VectorXd::Constant(prior_.size(), std::numeric_limits<double>::quiet_NaN()));
    for (Eigen::Index i = 0; i < own.mean.size(); ++i) {
      const Eigen::Index at = shared_.columns(r)[static_cast<std::size_t>(i)];
      const double precision = 1.0 / (own.std[i] * own.std[i]);
      information[at] += precision;
      pull[at] += precision * own.mean[i];
      alone.back()[at] = own.mean[i];
    }
  }
  const Eigen::VectorXd middle = pull.cwiseQuotient(information);
  Eigen::VectorXd best = middle;
  double least = cost(middle);
  for (const Eigen::VectorXd& one : alone) {
    const Eigen::VectorXd there = one.array().isFinite().select(one, middle);
    const double now = cost(there);
    if (now < least) least = now, best = there;
  }
  const Eigen::VectorXd around = kSpread * information.cwiseSqrt().cwiseInverse();
  fit_together(best, around.cwiseMin(prior_).cwiseMax(kNarrowest * prior_));
}

void JointFit::fit_together(const Eigen::VectorXd& start, const Eigen::VectorXd& spread) {
  progress_("fit all together", 0, 1);
  filter_ = fit_filter(parts(), PosteriorLinearizationFilter(filter_), start, spread);
  for (std::size_t r = 0; r < fits_.size(); ++r) {
    if (recordings_[r].predicted) continue;
    const FreeFit fit = free_fit(fits_[r]->whole(), shared_.of(r, filter_.anchor()));
    misfit_scales_[r] = fit.cost / std::max(1.0, fit.rows);
  }
}

}  // namespace tissue_stiffness
