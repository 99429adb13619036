// 100 simulated recordings: is the interval as wide as the errors are?
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tissue_stiffness/filter/consistency.hpp"
#include "verification/coverage.hpp"

namespace tissue_stiffness {
namespace {

TEST(Calibration, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const std::vector<Trial> trials = calibrate(100);
  ConsistencySum all, errors;
  int covered = 0, surprising = 0;
  for (const Trial& trial : trials) {
    covered += trial.covered ? 1 : 0;
    all.add(trial.nis, static_cast<int>(trial.dof));
    errors.add(trial.off * trial.off, 1);
    surprising += two_sided_p_value(trial.nis, trial.dof) < 0.05 ? 1 : 0;
  }
  std::printf(
      "100 seeds: 95 %% interval holds the truth on %d; NIS %.4f a row (p = %.3f), %d seeds beyond 95 %%; "
      "error^2 / variance %.2f; posterior std of log E %.4f\n",
      covered, all.mean_per_dof(), all.p_value(), surprising, errors.mean_per_dof(), trials.front().relative);
  EXPECT_GE(covered, 90);
  EXPECT_LE(covered, 98);
  EXPECT_GT(all.p_value(), 0.001);
  EXPECT_LE(surprising, 12);  // 5 expected; more than 12 once in a thousand times
  EXPECT_GT(errors.p_value(), 0.001);
}

}  // namespace
}  // namespace tissue_stiffness
