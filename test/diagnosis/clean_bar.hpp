#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "../estimation/bar.hpp"
#include "diagnosis/model_comparison.hpp"

namespace tissue_stiffness {

/// A bar under gravity, fitted to a recording in which nothing is hidden.
class CleanBar : public ::testing::Test {
 protected:
  void SetUp() override {
    const ModelSettings settings = box_settings(bar_under_gravity("{prior: 20.0e3, factor: 3}"));
    const Experiment experiment(settings, bar_mesh(), {20e3});
    recording_.frames = see_all(experiment, experiment.film(0.0, 0.02, 20), kNoise, 1);
    base_.recording_fit = std::make_unique<RecordingFit>(settings, bar_mesh(), recording_);
    const Model& model = base_.recording_fit->model();
    base_.fit = base_.recording_fit->fit(model.parameters().prior_mean(), 0.1 * model.parameters().prior_std());
    base_.rows = base_.recording_fit->rows(base_.fit.w);
  }

  Eigen::VectorXd slow() const {  // bends the bar to and fro, as missing physics does
    Eigen::VectorXd out = base_.rows.predicted;
    return out * (3.0 / std::sqrt(out.squaredNorm() / static_cast<double>(out.size())));
  }

  Recording recording_;
  FittedModel base_;
};

/// Returns a model without anything to fit.
inline Explained rigid(const Eigen::VectorXd& error) {
  Explained out{error, {}};
  out.linearisation.columns.resize(error.size(), 0);
  return out;
}

}  // namespace tissue_stiffness
