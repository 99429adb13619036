#include "tissue_stiffness/estimation/corrected_runs.hpp"

#include <algorithm>
#include <cmath>

#include "tissue_stiffness/estimation/compare.hpp"

namespace tissue_stiffness {
namespace {

int mode_count(const ReducedTrajectory& run) {
  return static_cast<int>(std::min<Eigen::Index>(StateCorrection::most_modes, run.frequencies().size()));
}

}  // namespace

ReducedTrajectory& CorrectedRuns::run(std::size_t i) {
  return dynamic_cast<ReducedTrajectory&>(ensemble_.trajectory(i));
}

void CorrectedRuns::restart(const Eigen::MatrixXd& sigma_points, double start) {
  ensemble_.restart(sigma_points, {start});
  correction_.restart();
  time_ = start;
  theta_ = model_.theta(sigma_points.col(0));
  const int modes = mode_count(run(0));
  shapes_ = run(0).mode_shapes(modes);
  in_basis_ = run(0).modes_in_basis(modes);
}

void CorrectedRuns::advance(double time) {
  ensemble_.advance(time);
  if (time > time_) correction_.advance(run(0), time - time_);
  time_ = std::max(time, time_);
}

Eigen::MatrixXd CorrectedRuns::sensitivity(const Frame& frame, const Prediction& central) const {
  return predict_along(model_, operators_, frame, theta_, ensemble_.displacements().col(0), central, shapes_);
}

void CorrectedRuns::correct(const Eigen::MatrixXd& step) {
  const Eigen::Index modes = in_basis_.cols();
  for (Eigen::Index i = 0; i < step.cols(); ++i) {
    run(static_cast<std::size_t>(i)).correct(in_basis_ * step.col(i).head(modes), in_basis_ * step.col(i).tail(modes));
  }
}

AnchoredFilter::Innovation CorrectedRuns::absorb(const Frame& frame, AnchoredFilter& filter) {
  advance(frame.time);
  const Ensemble::Predicted predicted = ensemble_.predict(frame);
  Prediction now = predicted.central;
  now.predicted = filter.predict(predicted.rows, filter.mean());
  const Eigen::VectorXd precision = row_weights(now).cwiseQuotient(now.sigma.cwiseAbs2());
  const StateCorrection::Whitened white =
      correction_.update(now.measured, predicted.rows, precision, sensitivity(frame, predicted.central));
  correct(white.step);
  const Eigen::VectorXd unit = Eigen::VectorXd::Ones(white.measured.size());
  return filter.update(white.measured, white.rows, unit, unit);
}

double CorrectedRuns::deviance(const std::vector<Frame>& frames, const Eigen::VectorXd& w, double start) {
  restart(w, start);
  double sum = 0.0;
  for (const Frame& frame : frames) {
    advance(frame.time);
    const Ensemble::Predicted predicted = ensemble_.predict(frame);
    const Prediction& now = predicted.central;
    const Eigen::VectorXd precision = row_weights(now).cwiseQuotient(now.sigma.cwiseAbs2());
    const StateCorrection::Whitened white =
        correction_.update(now.measured, predicted.rows, precision, sensitivity(frame, now));
    correct(white.step);
    sum += white.log_determinant + white.rows.squaredNorm();
  }
  return sum;
}

double modal_force_scale(const Model& model, const ForwardModel& forward, const std::vector<Frame>& frames,
                         const Eigen::VectorXd& w, double start) {
  const auto trajectory = forward.start(model.theta(w), start);
  const auto& run = dynamic_cast<const ReducedTrajectory&>(*trajectory);
  const int modes = mode_count(run);
  const Eigen::ArrayXd omega = run.frequencies().head(modes).array();
  double sum = 0.0;
  for (const Frame& frame : frames) {
    trajectory->advance(frame.time);
    sum += (omega.square() * run.modal_displacement().head(modes).array()).square().sum() +
           (omega * run.modal_velocity().head(modes).array()).square().sum();
  }
  return frames.empty() ? 0.0 : std::sqrt(sum / (static_cast<double>(frames.size()) * modes));
}

}  // namespace tissue_stiffness
