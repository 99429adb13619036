// The map shows where and when a model is valid: an error that is put into one part and one third is found there, and
// nowhere else.
#include "diagnosis/belief_map.hpp"

#include <gtest/gtest.h>

#include "../estimation/bar.hpp"

namespace tissue_stiffness {
namespace {

TEST(ExcessEvidence, SpeaksForWhatIsMoreThanNoise) {
  EXPECT_LT(log_evidence_of_excess(200.0, 200.0), -1.0);
  EXPECT_LT(log_evidence_of_excess(150.0, 200.0), log_evidence_of_excess(200.0, 200.0));
  EXPECT_GT(log_evidence_of_excess(300.0, 200.0), 5.0);
  EXPECT_GT(log_evidence_of_excess(3000.0, 2000.0), 5.0 * log_evidence_of_excess(300.0, 200.0));
}

TEST(BeliefMap, ShowsWhereAndWhenAModelFails) {
  const ModelSettings settings = box_settings(bar_under_gravity("{prior: 20.0e3, factor: 3}"));
  const Experiment experiment(settings, bar_mesh(), {20e3});
  Recording recording;
  recording.frames = see_all(experiment, experiment.film(0.0, 0.02, 30), kNoise, 1);
  FittedModel model;
  model.recording_fit = std::make_unique<RecordingFit>(settings, bar_mesh(), recording);
  const Model& body = model.recording_fit->model();
  model.fit = model.recording_fit->fit(body.parameters().prior_mean(), 0.1 * body.parameters().prior_std());
  model.rows = model.recording_fit->rows(model.fit.w);
  const ModelComparison comparison(model, Eigen::VectorXd::Zero(model.rows.error.size()));

  const BeliefMap clean = belief_map(model, model.rows.error, comparison);
  ASSERT_EQ(clean.nodes.size(), clean.parts.size());
  ASSERT_EQ(clean.probability.rows(), clean.centres.cols());
  EXPECT_GT(clean.centres.cols(), 3);
  EXPECT_GT(clean.probability.minCoeff(), 0.3);
  EXPECT_GT(clean.probability.mean(), 0.7);

  Eigen::VectorXd wrong = model.rows.error;
  const auto from = model.rows.frames.before(20);  // the last of three thirds
  for (Eigen::Index r = from; r < wrong.size(); ++r) {
    if (body.mesh().nodes(0, model.rows.nodes[r]) > 0.08) wrong[r] += 3.0;  // sigmas, alike everywhere: a displacement
  }
  const BeliefMap map = belief_map(model, wrong, comparison);
  for (Eigen::Index part = 0; part < map.probability.rows(); ++part) {
    const double x = map.centres(0, part);
    if (x > 0.085) {
      EXPECT_LT(map.probability(part, 2), 0.01) << x;
    }
    if (x < 0.065) {
      EXPECT_GT(map.probability(part, 2), 0.3) << x;
    }
    EXPECT_GT(map.probability(part, 0), 0.3) << x;
    EXPECT_GT(map.probability(part, 1), 0.3) << x;
  }
}

}  // namespace
}  // namespace tissue_stiffness
