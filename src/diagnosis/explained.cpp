#include "diagnosis/explained.hpp"

#include <Eigen/Cholesky>
#include <memory>
#include <utility>

#include "diagnosis/candidates.hpp"
#include "diagnosis/comparison_numbers.hpp"
#include "fit/nested_parameters.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSteps[] = {1.0, 4.0};  // squared steps that are tried, over their prior's standard deviation

// Returns the most probable unknowns of a linear model and its deviance there, with the noise as stated.
Eigen::VectorXd most_probable(const Linearisation& model, const Eigen::VectorXd& error, Eigen::Index unknowns,
                              double& deviance) {
  const auto j = model.columns.leftCols(unknowns);
  const Eigen::VectorXd mean = model.prior.head(unknowns);
  const Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(unknowns, unknowns) + j.transpose() * j;
  Eigen::VectorXd u = precision.ldlt().solve(j.transpose() * error + mean);
  deviance = (error - j * u).squaredNorm() + (u - mean).squaredNorm();
  return u;
}

Eigen::VectorXd moved(const RecordingFit& recording_fit, Eigen::VectorXd w, const std::map<std::string, double>& by) {
  for (const auto& [name, change] : by) {
    if (const Eigen::Index k = recording_fit.index(name); k >= 0) w[k] += change;
  }
  return w;
}

// Returns the place of a model with fewer effects; what is added stays as fitted, except amplitudes, which are absent.
Eigen::VectorXd nested(const RecordingFit& recording_fit, Eigen::VectorXd w, const std::map<std::string, double>& place,
                       const std::vector<std::string>& amplitudes) {
  const ParameterSpace& parameters = recording_fit.model().parameters();
  const Eigen::VectorXd mean = parameters.prior_mean();
  for (const std::string& name : amplitudes) w[recording_fit.index(name)] = mean[recording_fit.index(name)];
  return parameters.coordinates(place, std::move(w));
}

// A model with its time steps as free parameters, beside its fit without them.
class SteppedFit {
 public:
  explicit SteppedFit(const FittedModel& fitted)
      : recording_fit_(with_time_steps(*fitted.recording_fit, fitted.fit.w)),
        shared_(*recording_fit_, *fitted.recording_fit),
        at_(shared_.extend(fitted.fit.w)),
        prior_(recording_fit_->model().parameters().prior_std()),
        steps_(at_.size() - fitted.fit.w.size()) {}

  // `u`: where the linearisation leads [prior standard deviations].
  void start_at(const Eigen::VectorXd& u) { starts_.emplace_back(at_ + prior_.cwiseProduct(u)); }
  void start_at(const FittedSteps& known, const std::vector<std::string>& amplitudes) {
    starts_.push_back(moved(*recording_fit_, at_, known.moves));
    starts_.push_back(nested(*recording_fit_, at_, known.place, amplitudes));
  }
  void fit_from_best_start(double rival) {
    RecordingFit::Place best;
    for (const Eigen::VectorXd& start : starts_) {
      const RecordingFit::Place place = recording_fit_->scan_near(start, {});
      if (best.w.size() == 0 || place.cost < best.cost) best = place;
    }
    const NestedParameters own(*recording_fit_, *recording_fit_);
    if (best.w.size() > 0) fit_ = recording_fit_->quick_fit(best.w, own.spread(), 1.0, rival);
  }
  // Long steps lead a body that rings into another minimum, which no tangent shows.
  void fit_from_long_steps() {
    for (const double length : kSteps) {
      Eigen::VectorXd start = at_;
      start.tail(steps_) = length * prior_.tail(steps_);
      const BatchFit fit =
          recording_fit_->quick_fit(recording_fit_->scan_near(start, shared_.scanned()).w, shared_.spread());
      if (fit_.w.size() == 0 || fit.cost < fit_.cost) fit_ = fit;
    }
  }

  FittedSteps steps() const {
    FittedSteps out;
    out.cost = fit_.cost;
    out.place = recording_fit_->model().parameters().values(fit_.w);
    for (const auto& [name, value] : out.place) {
      const Eigen::Index k = recording_fit_->index(name);
      out.moves[name] = fit_.w[k] - at_[k];
    }
    return out;
  }
  FittedModel take() {
    RecordingRows rows = recording_fit_->rows(fit_.w);
    return {std::move(recording_fit_), std::move(fit_), std::move(rows)};
  }

 private:
  std::unique_ptr<RecordingFit> recording_fit_;
  NestedParameters shared_;
  Eigen::VectorXd at_, prior_;
  Eigen::Index steps_;  ///< number of the parameters that are steps, the last ones
  std::vector<Eigen::VectorXd> starts_;
  BatchFit fit_;
};

}  // namespace

double log_root_weights(const RecordingRows& rows) {
  return (rows.used.array() > 0.0).select(rows.used.array().log(), 0.0).sum();
}

std::vector<std::string> added_amplitudes(const RecordingFit& recording_fit, const RecordingFit& smaller) {
  std::vector<std::string> out;
  for (const FreeParameter& p : recording_fit.model().parameters().free()) {
    if (p.prior.kind == Quantity::Kind::normal && smaller.index(p.name) < 0) out.push_back(p.name);
  }
  return out;
}

Linearisation linearise_model(const FittedModel& fitted, const std::vector<std::string>& amplitudes) {
  const RecordingFit& recording_fit = *fitted.recording_fit;
  const Model& model = recording_fit.model();
  const Eigen::VectorXd& w = fitted.fit.w;
  const Eigen::VectorXd prior = model.parameters().prior_std();
  // Each tangent is read as far as its parameter is known while the others are held: no tangent reaches far along what they
  // can compensate.
  const Eigen::VectorXd known = fitted.fit.covariance.inverse().diagonal().cwiseInverse().cwiseSqrt();
  const Eigen::MatrixXd own = base_tangents(recording_fit, w, known, fitted.rows);
  const Eigen::MatrixXd steps = tangents_of_time_steps(recording_fit, w, fitted.rows);
  Linearisation out;
  out.columns.resize(own.rows(), own.cols() + steps.cols());
  out.columns << own * prior.asDiagonal(), steps;
  out.prior = Eigen::VectorXd::Zero(out.columns.cols());
  out.prior.head(w.size()) = (model.parameters().prior_mean() - w).cwiseQuotient(prior);
  out.parameters = w.size();
  for (const std::string& name : amplitudes) out.amplitudes.push_back(recording_fit.index(name));
  out.log_root_weights = log_root_weights(fitted.rows);
  return out;
}

Explained compared_residual(const FittedModel& fitted, const std::vector<std::string>& amplitudes, FittedNumerics numerics,
                            const FittedSteps& known, double rival) {
  Explained out{fitted.rows.error, linearise_model(fitted, amplitudes)};
  const RecordingFit& recording_fit = *fitted.recording_fit;
  const Eigen::Index all = out.linearisation.columns.cols(), own = out.linearisation.parameters;
  const bool far = numerics == FittedNumerics::far;
  if ((numerics == FittedNumerics::none && known.place.empty()) || recording_fit.model().nonlinear() || all == own)
    return out;
  double with = 0.0, without = 0.0;
  most_probable(out.linearisation, out.error, own, without);
  const Eigen::VectorXd u = most_probable(out.linearisation, out.error, all, with);
  const bool linear = without - with > 2.0 * kComparison.worthwhile && u[own] > 0.0;
  if (!linear && !far && known.place.empty()) return out;
  SteppedFit stepped(fitted);
  if (linear) stepped.start_at(u);
  if (!known.place.empty()) stepped.start_at(known, amplitudes);
  stepped.fit_from_best_start(rival);
  if (far) stepped.fit_from_long_steps();
  FittedSteps steps = stepped.steps();
  const FittedModel joint = stepped.take();
  const double gain = out.error.squaredNorm() - joint.rows.error.squaredNorm();
  if (!(gain > 2.0 * kComparison.worthwhile)) return out;
  return {joint.rows.error, linearise_model(joint, amplitudes), std::move(steps)};
}

}  // namespace tissue_stiffness
