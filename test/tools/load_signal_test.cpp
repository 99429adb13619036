#include "tools/load_signal.hpp"

#include <cmath>

#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

Signal signal(const std::string& yaml, const std::string& directory = ".") {
  return read_signal(parse_yaml(yaml, "scene.yaml"), directory);
}

TEST(LoadSignal, HoldsARampOutsideItsSpan) {
  const Signal ramp = signal("ramp: {from: 1, to: 3, start: 0.5, end: 1.5}");
  EXPECT_DOUBLE_EQ(ramp(0.0), 1.0);
  EXPECT_DOUBLE_EQ(ramp(1.0), 2.0);
  EXPECT_DOUBLE_EQ(ramp(9.0), 3.0);
}

TEST(LoadSignal, Oscillates) {
  EXPECT_NEAR(signal("sine: {amplitude: 2, frequency: 1, phase: 0.5}")(0.25), 2.0 * std::cos(0.5), 1e-12);
  const Signal raised = signal("raised_cosine: {amplitude: 2, frequency: 2}");
  EXPECT_DOUBLE_EQ(raised(0.0), 0.0);
  EXPECT_NEAR(raised(0.25), 2.0, 1e-12);
}

TEST(LoadSignal, StepsFromZero) {
  const Signal steps = signal("steps: {times: [1, 2], values: [5, -1]}");
  EXPECT_DOUBLE_EQ(steps(0.9), 0.0);
  EXPECT_DOUBLE_EQ(steps(1.0), 5.0);
  EXPECT_DOUBLE_EQ(steps(3.0), -1.0);
}

class LoadSignalFile : public Workbench {};

TEST_F(LoadSignalFile, InterpolatesAFile) {
  write("course.csv", "time,force\n0,1\n2,3\n");
  EXPECT_DOUBLE_EQ(signal("csv: {file: course.csv}", folder_)(1.0), 2.0);
  EXPECT_TRUE(says(input_error([&] { signal("csv: {file: none.csv}", folder_); }), {"none.csv"}));
}

TEST(LoadSignal, RefusesWhatItDoesNotKnow) {
  EXPECT_TRUE(says(input_error([] { signal("square: {amplitude: 1}"); }), {"scene.yaml", "ramp, sine"}));
  EXPECT_TRUE(says(input_error([] { signal("ramp: {to: 1, start: 2, end: 1}"); }), {"ramp.end", "found 1"}));
  EXPECT_TRUE(says(input_error([] { signal("steps: {times: [0, 1], values: [1]}"); }), {"2 times and 1 values"}));
}

}  // namespace
}  // namespace tissue_stiffness
