#include "nodes/load_silence.hpp"

#include <gtest/gtest.h>

namespace tissue_stiffness {
namespace {

constexpr double kInterval = 0.005;  // [s]

class LoadSilenceTest : public testing::Test {
 protected:
  LoadSilence loads;

  void add(double time) { loads.add({"/tool/wrench", time, Eigen::VectorXd::Zero(6)}); }
  void add(int from, int to) {
    for (int k = from; k < to; ++k) add(k * kInterval);
  }
  bool silent(double time) { return !loads.find(time).empty(); }
};

TEST_F(LoadSilenceTest, IsFiveIntervalsLong) {
  add(0, 100);
  EXPECT_FALSE(silent(0.495 + 0.024));
  EXPECT_TRUE(silent(0.495 + 0.026));
  EXPECT_EQ(loads.find(0.795), "no load on /tool/wrench for 0.3 s, where one comes every 0.005 s");
}

TEST_F(LoadSilenceTest, EndsWithTheNextSampleAndIsKnownAfterwards) {
  add(0, 100);
  add(200, 500);  // these came before the frames, as after a stall
  EXPECT_FALSE(silent(0.4));
  EXPECT_TRUE(silent(0.7));
  EXPECT_TRUE(silent(0.999));
  EXPECT_FALSE(silent(1.001));
  EXPECT_FALSE(silent(2.4));
}

// A stamp that is ahead, or a sample that comes late, makes neither a silence nor a longer interval.
TEST_F(LoadSilenceTest, IsNotMadeByBrokenStamps) {
  add(0, 50);
  add(0.9);
  EXPECT_FALSE(silent(0.25));
  add(51, 100);
  add(50 * kInterval);
  EXPECT_FALSE(silent(0.255));
  EXPECT_FALSE(silent(0.49));
  EXPECT_TRUE(silent(0.6));
}

TEST_F(LoadSilenceTest, IsNotKnownOfALoadThatHasHardlyBegun) {
  EXPECT_FALSE(silent(1.0));
  add(0, 3);
  EXPECT_FALSE(silent(1.0));
  add(3, 5);
  EXPECT_TRUE(silent(1.0));
  loads.clear();
  EXPECT_FALSE(silent(1.0));
}

TEST_F(LoadSilenceTest, ASlowLoadMayPauseForLonger) {
  for (int k = 0; k < 10; ++k) add(double(k));
  EXPECT_FALSE(silent(13.9));
  EXPECT_TRUE(silent(14.1));
}

}  // namespace
}  // namespace tissue_stiffness
