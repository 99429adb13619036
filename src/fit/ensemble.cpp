#include "fit/ensemble.hpp"

#include <utility>

#include "forward/for_each_index.hpp"

namespace tissue_stiffness {

void Ensemble::restart(const Eigen::MatrixXd& sigma_points, const RunStart& start) {
  theta_.clear();
  for (Eigen::Index i = 0; i < sigma_points.cols(); ++i) theta_.push_back(model_.parameters().theta(sigma_points.col(i)));
  runs_ = forward_.begin_all(theta_, start);
  displacements_ = Eigen::MatrixXd::Zero(model_.output_size(), sigma_points.cols());
}

void Ensemble::advance(double time) {
  std::vector<double> times;
  for (const Eigen::VectorXd& theta : theta_) times.push_back(time - model_.sensors().delay(theta));
  runs_->advance(times);
  runs_->outputs(displacements_);
}

Ensemble::Predicted Ensemble::predict(const Frame& frame) const {
  std::vector<Prediction> predictions(theta_.size());
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

}  // namespace tissue_stiffness
