// The queue hands frames out in order of time with their loads, waits for these, and drops what it cannot keep.
#include "nodes/frame_queue.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "frame_queue_test.hpp"

namespace tissue_stiffness {
namespace {

TEST_F(FrameQueueTest, HandsFramesOutInOrderOfTime) {
  frame(0.0);
  frame(0.2);
  frame(0.1);
  EXPECT_NEAR(take(), 0.0, 1e-9);
  EXPECT_NEAR(take(), 0.1, 1e-9);
  EXPECT_NEAR(take(), 0.2, 1e-9);
}

TEST_F(FrameQueueTest, OneStampIsOneFrame) {
  frame(0.0, "a");
  frame(0.0, "b");
  EXPECT_EQ(queue.take()->observations.size(), 2U);
}

TEST_F(PatientFrameQueueTest, AFrameWaitsForTheLoadBehindIt) {
  start();
  load(0.0);
  frame(0.1);
  std::thread late([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    load(0.12);
  });
  const auto work = queue.take();  // runs into the test's timeout if the frame does not go with its load
  late.join();
  EXPECT_EQ(work->loads.size(), 2U);
}

TEST_F(FrameQueueTest, AMissingLoadHoldsAFrameOnlyForAWhile) {
  queue.expect("pressure");
  frame(0.1);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(queue.take()->loads.empty());
  EXPECT_GE(Seconds(std::chrono::steady_clock::now() - begin).count(), 0.045);
}

TEST_F(FrameQueueTest, TheNewestWinWhenTooManyWait) {
  for (int i = 0; i < 5; ++i) frame(0.1 * i);
  EXPECT_EQ(queue.waiting(), 3U);
  EXPECT_EQ(queue.dropped(), 2U);
  EXPECT_NEAR(take(), 0.2, 1e-9);
}

TEST_F(FrameQueueTest, RestartForgetsWhatWaits) {
  frame(0.0);
  take();
  frame(0.1);
  queue.restart();
  EXPECT_EQ(queue.waiting(), 0U);
  frame(0.2);
  const auto work = queue.take();
  EXPECT_TRUE(work->new_epoch);
  EXPECT_NEAR((work->first_stamp - at(0.2)).toSec(), 0.0, 1e-9);
}

TEST_F(FrameQueueTest, WakeEndsTheWaitOnceAndLosesNothing) {
  std::thread worker([this] {
    const auto work = queue.take();
    ASSERT_TRUE(work);
    EXPECT_TRUE(work->observations.empty());
    EXPECT_FALSE(work->new_epoch);
  });
  queue.wake();
  worker.join();
  frame(0.0);
  EXPECT_EQ(queue.take()->observations.size(), 1U);
}

TEST_F(FrameQueueTest, StopEndsTheWait) {
  std::thread worker([this] { EXPECT_FALSE(queue.take()); });
  queue.stop();
  worker.join();
}

}  // namespace
}  // namespace tissue_stiffness
