// In 100 simulated recordings, the interval has to be as wide as the errors are.
#include "../figures.hpp"

namespace tissue_stiffness {
namespace {

TEST(Calibration, IntervalsHoldTheTruthAsOftenAsTheySay) {
  expect_all(coverage_figures());
}

}  // namespace
}  // namespace tissue_stiffness
