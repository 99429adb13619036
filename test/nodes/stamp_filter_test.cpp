#include "nodes/stamp_filter.hpp"

#include <gtest/gtest.h>

namespace tissue_stiffness {
namespace {

ros::Time at(double seconds) {
  return ros::Time(1e6 + seconds);
}

class StampFilterTest : public testing::Test {
 protected:
  StampFilter<int> filter{0.1};
  double now = 0.0;

  // Returns how many messages are believed.
  std::size_t add(double stamp) { return believe(filter.add(at(stamp), 0, now)); }
  std::size_t believe(const std::vector<StampFilter<int>::Stamped>& believed) {
    for (const auto& message : believed) filter.advance(message.stamp);
    return believed.size();
  }
  // A topic of a message every 0.2 s.
  void start() {
    for (const double t : {0.0, 0.2, 0.4}) {
      now = t;
      add(t);
    }
  }
};

TEST_F(StampFilterTest, ThreeFirstMessagesAgree) {
  EXPECT_EQ(add(0.0), 0U);
  EXPECT_EQ(add(0.1), 0U);
  EXPECT_EQ(add(0.2), 3U);
  EXPECT_EQ(add(0.3), 1U);
}

TEST_F(StampFilterTest, ABrokenOneAmongTheFirstIsLeftOutAlone) {
  for (const double broken : {3600.0, -3600.0, 5.0}) {
    for (int place = 0; place < 3; ++place) {
      filter.forget();
      const std::size_t before = filter.left_out();
      std::size_t believed = 0;
      for (int k = 0; k < 6; ++k) {
        if (k == place) believed += add(broken);
        believed += add(0.1 * k);
      }
      EXPECT_EQ(believed, 6U) << broken << ", " << place;
      EXPECT_EQ(filter.left_out() - before, 1U) << broken << ", " << place;
    }
  }
}

TEST_F(StampFilterTest, ALoneMessageIsHeldUntilTheCallerBelievesIt) {
  now = 5.0;
  add(0.0);
  ASSERT_TRUE(filter.holds());
  EXPECT_DOUBLE_EQ(filter.silent_from(), 5.1);
  EXPECT_EQ(believe(filter.release()), 1U);
  EXPECT_FALSE(filter.holds());
}

TEST_F(StampFilterTest, ABrokenStampOfASlowTopicIsLeftOut) {
  start();
  now = 0.6;
  EXPECT_EQ(add(3600.0), 0U);
  EXPECT_NEAR(filter.silent_from(), 1.6, 1e-9);
  now = 0.8;
  EXPECT_EQ(add(0.8), 1U);
  EXPECT_FALSE(filter.holds());
  EXPECT_EQ(filter.left_out(), 1U);
  EXPECT_EQ(filter.last_left_out(), "3599.6 s ahead");
}

TEST_F(StampFilterTest, BelievesWhatTheCallerAgreesWithAndLeavesOutTheRest) {
  start();
  for (const double stamp : {50.0, 50.1, 3600.0}) EXPECT_EQ(add(stamp), 0U);
  EXPECT_TRUE(filter.release_if([](const ros::Time&) { return false; }).empty());
  EXPECT_TRUE(filter.holds());
  EXPECT_EQ(filter.release_if([](const ros::Time& stamp) { return stamp < at(60.0); }).size(), 2U);
  EXPECT_FALSE(filter.holds());
  EXPECT_EQ(filter.left_out(), 1U);
}

TEST_F(StampFilterTest, TellsWhatCameAfterASilence) {
  start();
  now = 1.3;
  EXPECT_FALSE(filter.add(at(1.2), 0, now).front().after_silence);
  now = 9.0;
  for (const double t : {9.0, 9.1}) filter.add(at(t), 0, now);
  const auto believed = filter.add(at(9.2), 0, now);
  ASSERT_EQ(believed.size(), 3U);
  EXPECT_TRUE(believed.front().after_silence);
  EXPECT_FALSE(believed.back().after_silence);
}

// A recording that is replayed ten times more slowly.
TEST_F(StampFilterTest, SilenceIsMeasuredByTheArrivals) {
  for (const double t : {0.0, 0.2, 0.4}) {
    now = 10.0 * t;
    add(t);
  }
  EXPECT_NEAR(filter.silent_from(), 4.0 + 5.0 * 2.0, 1e-9);
}

TEST_F(StampFilterTest, APauseAfterTheFirstMessageCostsOnlyThisOne) {
  EXPECT_EQ(add(0.0), 0U);
  EXPECT_EQ(add(5.0), 0U);
  EXPECT_EQ(add(5.1), 0U);
  EXPECT_EQ(add(5.2), 3U);
  EXPECT_EQ(filter.left_out(), 1U);
  EXPECT_EQ(filter.last_left_out(), "5.2 s back");
}

TEST_F(StampFilterTest, MessagesThatOvertakeEachOtherAreBelieved) {
  start();
  EXPECT_EQ(add(0.1), 1U);
  EXPECT_EQ(add(-0.2), 0U);
}

TEST_F(StampFilterTest, StartingOverKeepsTheInterval) {
  start();
  filter.start_over();
  EXPECT_FALSE(filter.stamps().seen);
  EXPECT_NEAR(filter.stamps().interval, 0.2, 1e-9);
}

}  // namespace
}  // namespace tissue_stiffness
