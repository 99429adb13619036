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

// The loads' errors move the modulus by 1 (a logarithm), and the filter knows it to 0.01. Returns whether a filter at `mean`
// has left the study.
bool left(double mean, const std::string& implausible) {
  const Model model(box_settings(bar_under_gravity(prior(20e3, 3))), bar_mesh());
  SystematicError error(model);
  InputStudy::Answer answer = answer_at_zero(1.0);
  answer.implausible = implausible;
  error.take_inputs(answer, 1000.0);
  error.set_runs_at(Eigen::VectorXd::Zero(1), 1.0);
  return error.left_study({Eigen::VectorXd::Constant(1, mean), Eigen::MatrixXd::Constant(1, 1, 1e-4), {1.0, 1000.0}});
}

TEST(SystematicError, AStudyIsLeftWhenTheRunsMoveBeyondItsInterval) {
  EXPECT_FALSE(left(0.9, ""));
  EXPECT_TRUE(left(-1.1, ""));
}

TEST(SystematicError, AStudyThatIsNotBelievedIsLeftAsSoonAsTheFilterMoves) {
  EXPECT_FALSE(left(0.005, "the gain would have to be 9"));
  EXPECT_TRUE(left(-0.2, "the gain would have to be 9"));
}

}  // namespace
}  // namespace tissue_stiffness
