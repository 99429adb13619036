#include "estimation/systematic_error.hpp"

#include <gtest/gtest.h>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

// 1000 rows were tested with a mean square of 1.2. Returns whether it has risen when the further rows have `since`.
bool risen(double since, double further) {
  const Model model(box_settings(bar_under_gravity(prior(20e3, 3))), bar_mesh());
  SystematicError error(model);
  InputStudy::Answer answer;
  answer.fitted = true;
  answer.recordings.resize(1);
  answer.w = answer.mode = answer.asked = Eigen::VectorXd::Zero(1);
  answer.from_noise = answer.from_loads = answer.from_mesh = answer.from_constants = Eigen::MatrixXd::Zero(1, 1);
  error.take_inputs(answer, 1000.0);
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

}  // namespace
}  // namespace tissue_stiffness
