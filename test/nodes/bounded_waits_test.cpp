#include "nodes/bounded_waits.hpp"

#include <gtest/gtest.h>

namespace tissue_stiffness {
namespace {

using std::chrono::milliseconds;

TEST(BoundedWaits, AVainWaitIsNotRepeatedForTenTimesAsLong) {
  BoundedWaits waits(milliseconds(100));
  const BoundedWaits::Clock::time_point start{};
  EXPECT_EQ(waits.until("tool", start), start + milliseconds(100));
  const auto end = start + milliseconds(100);
  waits.in_vain("tool", start, end);
  EXPECT_EQ(waits.until("tool", end + milliseconds(10)), end + milliseconds(10));
  EXPECT_EQ(waits.until("tool", end + milliseconds(999)), end + milliseconds(999));
  EXPECT_EQ(waits.until("tool", end + milliseconds(1000)), end + milliseconds(1100));
  EXPECT_EQ(waits.until("camera", end), end + milliseconds(100));
}

TEST(BoundedWaits, NotHavingWaitedIsNoVainWait) {
  BoundedWaits waits(milliseconds(100));
  const BoundedWaits::Clock::time_point start{};
  waits.in_vain("tool", start, start + milliseconds(100));
  for (int t = 200; t < 1100; t += 100) waits.in_vain("tool", start + milliseconds(t), start + milliseconds(t));
  EXPECT_EQ(waits.until("tool", start + milliseconds(1100)), start + milliseconds(1200));
}

}  // namespace
}  // namespace tissue_stiffness
