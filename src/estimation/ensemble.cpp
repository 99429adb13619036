#include "tissue_stiffness/estimation/ensemble.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <exception>

namespace tissue_stiffness {
namespace {

// Runs act(i) for i < count in parallel; the error of the lowest i is thrown, whatever the threads did.
template <typename Act>
void for_each_index(std::size_t count, const Act& act) {
  std::vector<std::exception_ptr> errors(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    try {
      act(i);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace

void Ensemble::restart(const Eigen::MatrixXd& sigma_points, double start) {
  trajectories_.clear();
  trajectories_.resize(static_cast<std::size_t>(sigma_points.cols()));
  theta_.resize(trajectories_.size());
  for_each_index(trajectories_.size(), [&](std::size_t i) {
    theta_[i] = model_.theta(sigma_points.col(static_cast<Eigen::Index>(i)));
    trajectories_[i] = forward_.start(theta_[i], start);
  });
  displacements_ = Eigen::MatrixXd::Zero(model_.fem().dof_count(), sigma_points.cols());
}

void Ensemble::advance(double time) {
  for_each_index(trajectories_.size(), [&](std::size_t i) {
    trajectories_[i]->advance(time - model_.delay(theta_[i]));
    displacements_.col(static_cast<Eigen::Index>(i)) = trajectories_[i]->displacement();
  });
}

Ensemble::Predicted Ensemble::predict(const Frame& frame) const {
  std::vector<Prediction> predictions(trajectories_.size());
  for_each_index(predictions.size(), [&](std::size_t i) {
    predictions[i] = predict_frame(model_, operators_, frame, theta_[i], displacements_.col(static_cast<Eigen::Index>(i)));
  });
  Predicted out;
  out.rows.resize(predictions.front().predicted.size(), static_cast<Eigen::Index>(predictions.size()));
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    out.rows.col(static_cast<Eigen::Index>(i)) = predictions[i].predicted;
  }
  out.central = std::move(predictions.front());
  return out;
}

Prediction predict_frame(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                         const Frame& frame, const Eigen::VectorXd& theta, const Eigen::VectorXd& displacement) {
  const double since = frame.time - model.first_stamp() - model.settings().time.start;
  const bool observes = model.observes();
  const ObservedMotion seen =
      observes ? model.observe(theta, since, displacement) : ObservedMotion{model.mesh(), since, {}};
  std::vector<Prediction> parts;
  for (const Observation& observation : frame.observations) {
    const auto& sensor = *operators[static_cast<std::size_t>(observation.source)];
    parts.push_back(sensor.predict(observation, observes ? seen.displacement : displacement));
    const bool named = observation.kind == ObservationKind::vertices || observation.kind == ObservationKind::markers;
    if (!named) parts.back().predicted.array() += seen.outward;
  }
  return concatenate(parts);
}

}  // namespace tissue_stiffness
