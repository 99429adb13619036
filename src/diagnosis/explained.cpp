#include "diagnosis/explained.hpp"

#include <Eigen/Cholesky>

#include "diagnosis/candidates.hpp"
#include "diagnosis/comparison_numbers.hpp"
#include "fit/nested_parameters.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSteps[] = {1.0, 4.0};  // squared steps that are tried, over their prior's standard deviation
constexpr double kSpread = 0.05;         // prior standard deviations, of the fit that starts where the linearisation leads

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
  const Eigen::VectorXd mean = recording_fit.model().parameters().prior_mean();
  for (const std::string& name : amplitudes) w[recording_fit.index(name)] = mean[recording_fit.index(name)];
  for (const auto& [name, value] : place) {
    if (const Eigen::Index k = recording_fit.index(name); k >= 0) w[k] = value;
  }
  return w;
}

Eigen::VectorXd best_of(const RecordingFit& recording_fit, const std::vector<Eigen::VectorXd>& starts) {
  RecordingFit::Place best;
  for (const Eigen::VectorXd& start : starts) {
    const RecordingFit::Place place = recording_fit.scan_near(start, {});
    if (best.w.size() == 0 || place.cost < best.cost) best = place;
  }
  return best.w;
}

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
  FittedModel joint;
  joint.recording_fit = with_time_steps(recording_fit, fitted.fit.w);
  const RecordingFit& stepped = *joint.recording_fit;
  const NestedParameters shared(stepped, recording_fit);
  const Eigen::VectorXd at = shared.extend(fitted.fit.w), prior = stepped.model().parameters().prior_std();
  const Eigen::VectorXd near = kSpread * prior;
  std::vector<Eigen::VectorXd> starts;
  if (linear) starts.emplace_back(at + prior.cwiseProduct(u));
  if (!known.place.empty()) {
    starts.push_back(moved(stepped, at, known.moves));
    starts.push_back(nested(stepped, at, known.place, amplitudes));
  }
  if (!starts.empty()) joint.fit = stepped.quick_fit(best_of(stepped, starts), near, 1.0, rival);
  // Long steps lead a body that rings into another minimum, which no tangent shows.
  const std::vector<Eigen::Index> tuning = shared.scanned();
  for (const double length : kSteps) {
    if (!far) break;
    Eigen::VectorXd far_off = at;
    far_off.tail(all - own) = length * prior.tail(all - own);
    const BatchFit fit = stepped.quick_fit(stepped.scan_near(far_off, tuning).w, shared.spread());
    if (joint.fit.w.size() == 0 || fit.cost < joint.fit.cost) joint.fit = fit;
  }
  joint.rows = stepped.rows(joint.fit.w);
  const double gain = out.error.squaredNorm() - joint.rows.error.squaredNorm();
  if (!(gain > 2.0 * kComparison.worthwhile)) return out;
  FittedSteps steps;
  steps.cost = joint.fit.cost;
  const auto& free = stepped.model().parameters().free();
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    steps.place[free[i].name] = joint.fit.w[k];
    steps.moves[free[i].name] = joint.fit.w[k] - at[k];
  }
  return {joint.rows.error, linearise_model(joint, amplitudes), std::move(steps)};
}

}  // namespace tissue_stiffness
