#include "estimation/systematic_error.hpp"

#include <gtest/gtest.h>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

// Answers a question that was asked at zero, with a variance of the loads' errors.
InputStudy::Answer answer_at_zero(double from_loads) {
  InputStudy::Answer answer;
  answer.fitted = true;
  answer.recordings.resize(1);
  answer.w = answer.mode = answer.asked = Eigen::VectorXd::Zero(1);
  answer.from_noise = answer.from_mesh = answer.from_constants = Eigen::MatrixXd::Zero(1, 1);
  answer.from_loads = Eigen::MatrixXd::Constant(1, 1, from_loads);
  return answer;
}

// 1000 rows were tested with a mean square of 1.2. Returns whether it has risen when the further rows have `since`.
bool risen(double since, double further) {
  const Model model(box_settings(bar_under_gravity(prior(20e3, 3))), bar_mesh());
  SystematicError error(model);
  error.take_inputs(answer_at_zero(0.0), 1000.0);
  error.set_runs_at(Eigen::VectorXd::Zero(1), 1.2);
  const double rows = 1000.0 + further;
  return error.misfit_has_risen({(1.2 * 1000.0 + since * further) / rows, rows});
}

TEST(SystematicError, NoticesThatTheMisfitHasRisenSinceItsTest) {
  EXPECT_FALSE(risen(1.2, 0.0));
  EXPECT_FALSE(risen(2.4, 1e3));
  EXPECT_TRUE(risen(3.2, 1e3));
  EXPECT_FALSE(risen(3.2, 9.0)) << "nine rows may do so by chance";
}

TEST(SystematicError, NothingRisesBeforeATest) {
  const Model model(box_settings(bar_under_gravity(prior(20e3, 3))), bar_mesh());
  EXPECT_FALSE(SystematicError(model).misfit_has_risen({100.0, 1e4}));
}

// The loads' errors move the modulus by 1 (a logarithm), and the filter knows it to 0.01. The study's runs left the mean
// square `studied`. Returns whether a filter at `mean` that leaves `now` has left the study.
bool left(double mean, double studied, double now) {
  const Model model(box_settings(bar_under_gravity(prior(20e3, 3))), bar_mesh());
  SystematicError error(model);
  error.take_inputs(answer_at_zero(1.0), 1000.0);
  error.set_runs_at(Eigen::VectorXd::Zero(1), studied);
  return error.left_study({Eigen::VectorXd::Constant(1, mean), Eigen::MatrixXd::Constant(1, 1, 1e-4), {now, 1000.0}});
}

TEST(SystematicError, AStudyIsLeftWhenTheRunsMoveBeyondItsInterval) {
  EXPECT_FALSE(left(0.9, 1.0, 1.0));
  EXPECT_TRUE(left(-1.1, 1.0, 1.0));
}

TEST(SystematicError, AStudyThatWasAskedTooEarlyIsLeftAsSoonAsTheFilterMoves) {
  EXPECT_FALSE(left(0.005, 27.0, 1.0));
  EXPECT_TRUE(left(-0.2, 27.0, 1.0));
}

TEST(SystematicError, AStudyOfAModelThatStaysWrongIsNotLeftWithinItsInterval) {
  EXPECT_FALSE(left(-0.2, 27.0, 27.0));
  EXPECT_TRUE(left(-1.1, 27.0, 27.0));
}

}  // namespace
}  // namespace tissue_stiffness
