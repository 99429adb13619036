#include "nodes/transform_wait.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

namespace tissue_stiffness {
namespace {

using Clock = TransformWait::Clock;
constexpr std::chrono::seconds kLong{60};  // a wait that needs so long has missed what it waits for

geometry_msgs::TransformStamped transform(const std::string& parent, const std::string& child, double seconds) {
  geometry_msgs::TransformStamped out;
  out.header.frame_id = parent;
  out.header.stamp = ros::Time(seconds);
  out.child_frame_id = child;
  out.transform.rotation.w = 1.0;
  return out;
}

class TransformWaitTest : public testing::Test {
 protected:
  void put(const std::string& parent, const std::string& child, double seconds, bool fixed = false) {
    ASSERT_TRUE(buffer_.setTransform(transform(parent, child, seconds), "test", fixed));
  }
  bool wait(double seconds, Clock::duration longest) {
    return wait_.wait("model", "probe", ros::Time(seconds), Clock::now() + longest, reason_);
  }
  std::future<bool> begin(double seconds) {
    return std::async(std::launch::async, [this, seconds] { return wait(seconds, kLong); });
  }

  tf2::BufferCore buffer_;
  TransformWait wait_{buffer_};
  std::string reason_;
};

TEST_F(TransformWaitTest, WhatIsThereIsNotWaitedFor) {
  put("model", "probe", 0.0, true);
  EXPECT_TRUE(wait(5.0, Clock::duration::zero()));
}

TEST_F(TransformWaitTest, TheEndSaysWhichFrameIsMissing) {
  put("model", "camera", 0.0, true);
  const Clock::time_point begun = Clock::now();
  EXPECT_FALSE(wait(5.0, std::chrono::milliseconds(30)));
  EXPECT_GE(Clock::now() - begun, std::chrono::milliseconds(30));
  EXPECT_NE(reason_.find("probe"), std::string::npos) << reason_;
}

TEST_F(TransformWaitTest, TransformsThatDoNotHelpEndNoWait) {
  put("model", "arm", 0.0, true);
  const Clock::time_point begun = Clock::now();
  std::future<bool> found = begin(5.0);
  put("model", "camera", 0.0, true);
  put("arm", "probe", 4.0);  // older than what is asked for
  EXPECT_EQ(found.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout);
  put("arm", "probe", 6.0);
  EXPECT_TRUE(found.get());
  EXPECT_LT(Clock::now() - begun, kLong / 2);
}

// A transform may come at any instant of a wait: before the buffer is asked, after that, or when the wait has begun.
TEST_F(TransformWaitTest, NoArrivalIsMissed) {
  const Clock::time_point begun = Clock::now();
  put("model", "probe", 1.0);
  for (int k = 2; k < 2000; ++k) {
    std::future<bool> found = begin(k);
    put("model", "probe", k);
    ASSERT_TRUE(found.get()) << "round " << k;
  }
  EXPECT_LT(Clock::now() - begun, kLong);
}

TEST_F(TransformWaitTest, ArrivalsWithoutEndDoNotLengthenAWait) {
  std::atomic<bool> ended{false};
  std::thread others([&] {
    for (int k = 1; !ended; ++k) buffer_.setTransform(transform("model", "camera", 1e-3 * k), "test", false);
  });
  const Clock::time_point begun = Clock::now();
  EXPECT_FALSE(wait(5.0, std::chrono::milliseconds(50)));
  EXPECT_LT(Clock::now() - begun, kLong / 2);
  ended = true;
  others.join();
}

}  // namespace
}  // namespace tissue_stiffness
