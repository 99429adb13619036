// An epoch begins where a recording starts again, where the clock jumps and after a long silence, and nowhere else.
#include <gtest/gtest.h>

#include <optional>
#include <thread>

#include "frame_queue_test.hpp"

namespace tissue_stiffness {
namespace {

TEST_F(FrameQueueTest, TheFirstStampIsTheEarliestOfAnyTopic) {
  load(0.05);
  frame(0.1);
  const auto work = queue.take();
  EXPECT_TRUE(work->new_epoch);
  EXPECT_NEAR((work->first_stamp - at(0.05)).toSec(), 0.0, 1e-9);
}

TEST_F(FrameQueueTest, ALoopStartsANewEpoch) {
  for (const double t : {0.0, 0.01, 0.02}) frame(t);
  EXPECT_TRUE(queue.take()->new_epoch);
  for (int k = 0; k < 2; ++k) EXPECT_FALSE(queue.take()->new_epoch);
  for (const double t : {0.0, 0.01, 0.02}) frame(t);  // a recording of 0.02 s that starts again
  const auto work = queue.take();
  EXPECT_TRUE(work->new_epoch);
  EXPECT_EQ(work->beginning, FrameQueue::Beginning::stated);
  EXPECT_NEAR((work->first_stamp - at(0.0)).toSec(), 0.0, 1e-9);
}

TEST_F(FrameQueueTest, ALateFrameDoesNot) {
  frame(0.0);
  frame(0.3);
  frame(0.2);
  take();
  take();
  frame(0.1);
  EXPECT_FALSE(queue.take()->new_epoch);
}

TEST_F(FrameQueueTest, LoadsOfTheNextLapWaitForItsFrames) {
  for (const double t : {0.0, 0.5, 1.0}) {
    load(t);
    frame(t);
  }
  for (const double t : {0.0, 0.1, 0.2}) load(t);  // the load's topic starts again before the last frame was taken
  EXPECT_EQ(queue.take()->loads.size(), 3U);
  EXPECT_TRUE(queue.take()->loads.empty());
  EXPECT_TRUE(queue.take()->loads.empty());
  for (const double t : {0.0, 0.1, 0.2}) frame(t);
  const auto work = queue.take();
  EXPECT_TRUE(work->new_epoch);
  EXPECT_EQ(work->loads.size(), 3U);
}

TEST_F(FrameQueueTest, ATopicThatMissedALapJoinsTheNewest) {
  for (int lap = 0; lap < 3; ++lap) {
    for (int k = 0; k < 3; ++k) load(k * (1.0 - 0.4 * lap));  // each lap ends before the last one did
    for (int k = 0; lap == 0 && k < 3; ++k) frame(1.8 + 0.1 * k);
  }
  for (int k = 0; k < 3; ++k) take();
  for (const double t : {-0.6, -0.5, -0.4}) frame(t);  // the frame's topic jumps for the first time
  const auto work = queue.take();
  EXPECT_TRUE(work->new_epoch);
  EXPECT_EQ(work->loads.size(), 3U);
}

TEST_F(PatientFrameQueueTest, AClockThatIsSetWhileMessagesComeIsNoNewBody) {
  start();
  for (const double jump : {-900.0, 5000.0, -3000.0}) {
    for (const double t : {0.0, 0.1, 0.2}) {
      load(jump + t);
      frame(jump + t);
    }
    const auto work = queue.take();
    EXPECT_TRUE(work->new_epoch);
    EXPECT_EQ(work->beginning, FrameQueue::Beginning::jump);
    EXPECT_NEAR((work->first_stamp - at(jump)).toSec(), 0.0, 1e-9);
    EXPECT_EQ(work->loads.size(), 3U);
    for (int k = 0; k < 2; ++k) EXPECT_FALSE(queue.take()->new_epoch);
  }
  queue.restart();
  for (const double t : {0.0, 0.1, 0.2}) frame(t);
  load(0.2);
  EXPECT_EQ(queue.take()->beginning, FrameQueue::Beginning::stated);
}

TEST_F(FrameQueueTest, WhatComesAfterALongSilenceMayBeAnotherBody) {
  start();
  std::this_thread::sleep_for(Seconds(0.8));
  for (const double t : {100.0, 100.1, 100.2}) {
    frame(t);
    load(t);
  }
  EXPECT_EQ(queue.take()->beginning, FrameQueue::Beginning::unknown);
}

// The first messages of a lap may be lost. The body was at rest when they were sent, but long afterwards it is not. What
// comes again at stamps that were seen must not count twice, so it is no other time of the same body.
TEST_F(PatientFrameQueueTest, ALoopThatLosesItsFirstMessagesIsALoop) {
  const auto play = [&](double from) {
    std::optional<FrameQueue::Work> first;
    for (double t = from; t < 8.05; t += 0.1) {
      frame(t);
      if (queue.waiting() == 3 && !first) first = queue.take();
    }
    for (int k = 0; k < 3; ++k) take();
    return *first;
  };
  play(0.0);
  const auto lap = play(0.4);
  EXPECT_EQ(lap.beginning, FrameQueue::Beginning::stated);
  EXPECT_NEAR((lap.first_stamp - at(0.0)).toSec(), 0.0, 1e-9);
  const auto late = play(4.0);
  EXPECT_EQ(late.beginning, FrameQueue::Beginning::unknown);
  EXPECT_NEAR((late.first_stamp - at(4.0)).toSec(), 0.0, 1e-9);
  EXPECT_EQ(play(0.1).beginning, FrameQueue::Beginning::stated) << "the first lap tells where the recording begins";
}

// A clock that has jumped stamps all that follow.
TEST_F(PatientFrameQueueTest, AJumpIsBelievedWhenThreeMessagesAgree) {
  for (const double t : {0.0, 0.1, 0.2}) frame(t);
  for (int k = 0; k < 3; ++k) take();
  frame(1000.0);
  frame(1000.1);
  EXPECT_EQ(queue.waiting(), 0U);
  frame(1000.2);
  EXPECT_EQ(queue.waiting(), 3U);
  const auto work = queue.take();
  EXPECT_TRUE(work->new_epoch);
  EXPECT_NEAR((work->first_stamp - at(1000.0)).toSec(), 0.0, 1e-9);
  EXPECT_EQ(queue.broken_stamps(), 0U);
}

// A pause in the recording is no new run.
TEST_F(PatientFrameQueueTest, APauseGoesOn) {
  for (const double t : {0.0, 0.1, 0.2}) frame(t);
  for (int k = 0; k < 3; ++k) take();
  for (const double t : {10.0, 10.1, 10.2}) frame(t);
  const auto work = queue.take();
  EXPECT_FALSE(work->new_epoch);
  EXPECT_NEAR((work->stamp - at(10.0)).toSec(), 0.0, 1e-9);
}

TEST_F(PatientFrameQueueTest, AMinuteOfSilenceStartsANewEpoch) {
  start();
  const auto after = [&](double silence) {
    for (const double t : {0.0, 0.1, 0.2}) {
      load(silence + t);
      frame(silence + t);
    }
    const bool anew = queue.take()->new_epoch;
    for (int k = 0; k < 2; ++k) take();
    return anew;
  };
  EXPECT_FALSE(after(59.0));
  EXPECT_TRUE(after(200.0));
}

}  // namespace
}  // namespace tissue_stiffness
