#include "nodes/frame_queue.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tissue_stiffness {
namespace {

using Seconds = std::chrono::duration<double>;

ros::Time at(double seconds) {
  return ros::Time(1e6 + seconds);
}

class FrameQueueTest : public testing::Test {
 protected:
  explicit FrameQueueTest(Seconds patience = Seconds(0.05)) : queue(patience, 3) {}

  FrameQueue queue;

  void frame(double seconds, const std::string& topic = "contour") {
    queue.add_observation(topic, at(seconds), [] { return Observation(); });
  }
  void load(double seconds) {
    queue.add_load("pressure", at(seconds), [seconds] {
      return LoadSample{"pressure", seconds, Eigen::VectorXd::Zero(1)};
    });
  }
  // The first three messages of both topics are believed because they agree.
  void start() {
    for (const double t : {-0.3, -0.2, -0.1}) {
      load(t);
      frame(t);
    }
    for (int k = 0; k < 3; ++k) take();
  }
  double take() {
    const auto work = queue.take();
    return (work->stamp - ros::Time(1e6)).toSec();
  }
  // Adds a load and a frame, which go on from the ones before, and takes them.
  FrameQueue::Work take_next(double& now) {
    load(now);
    frame(now);
    auto work = queue.take();
    EXPECT_NEAR((work->stamp - at(now)).toSec(), 0.0, 1e-9);
    EXPECT_FALSE(work->new_epoch);
    now += 0.1;
    return std::move(*work);
  }
};

class PatientFrameQueueTest : public FrameQueueTest {
 protected:
  PatientFrameQueueTest() : FrameQueueTest(Seconds(1e6)) {}
};

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

// A sensor's clock is set wrongly for a while: what it sends then belongs to no frame, and afterwards it does again.
TEST_F(PatientFrameQueueTest, ATopicThatJumpedAloneJoinsTheOthersAgain) {
  start();
  for (const double t : {3600.0, 3600.1, 3600.2}) load(t);
  frame(0.0);
  EXPECT_TRUE(queue.take()->loads.empty());
  for (const double t : {0.0, 0.1, 0.2}) load(t);
  frame(0.1);
  const auto work = queue.take();
  EXPECT_FALSE(work->new_epoch);
  EXPECT_EQ(work->loads.size(), 3U);
}

TEST_F(FrameQueueTest, FramesThatJumpedAloneJoinTheirLoadsAgain) {
  start();
  for (const double t : {3600.0, 3600.1, 3600.2}) frame(t);
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(queue.take()->loads.empty());
  load(0.0);
  for (const double t : {0.0, 0.1, 0.2}) frame(t);
  for (const double t : {0.1, 0.2}) load(t);
  const auto work = queue.take();
  EXPECT_TRUE(work->new_epoch);
  EXPECT_EQ(work->beginning, FrameQueue::Beginning::jump);
  EXPECT_NEAR((work->first_stamp - at(0.0)).toSec(), 0.0, 1e-9);
  EXPECT_NEAR((work->stamp - at(0.0)).toSec(), 0.0, 1e-9);
  EXPECT_EQ(work->loads.size(), 2U);
}

// One message of a topic is stamped wrongly, and the next ones go on as before.
TEST_F(PatientFrameQueueTest, ABrokenStampIsLeftOut) {
  start();
  std::size_t broken = 0;
  double now = 0.0;
  const auto go_on = [&] { EXPECT_EQ(take_next(now).loads.size(), 1U); };
  for (int k = 0; k < 3; ++k) go_on();
  for (const double jump : {5.0, 4.2e9, 3600.0, -1.0, -900.0}) {
    frame(now + jump);
    go_on();
    load(now + jump);
    go_on();
    EXPECT_EQ(queue.broken_stamps(), broken += 2);
  }
  EXPECT_NE(queue.last_broken_stamp().find("pressure: 899.9 s back"), std::string::npos) << queue.last_broken_stamp();
  EXPECT_EQ(queue.dropped(), 0U);
}

// A silence makes no broken stamp believed, whether the other topics go on meanwhile or are silent too.
TEST_F(FrameQueueTest, ABrokenStampBeforeASilenceIsLeftOut) {
  start();
  double now = 0.0;
  const auto go_on = [&] { take_next(now); };
  for (int k = 0; k < 3; ++k) go_on();
  frame(now + 3600.0);
  load(now);
  EXPECT_TRUE(queue.take()->observations.empty()) << "long after the topic fell silent";
  go_on();
  EXPECT_EQ(queue.broken_stamps(), 1U);
  load(now - 900.0);
  frame(now + 3600.0);
  EXPECT_TRUE(queue.take()->observations.empty()) << "long after both fell silent";
  go_on();
  EXPECT_EQ(queue.broken_stamps(), 3U);
  load(now - 900.0);
  frame(now + 3600.0);
  EXPECT_TRUE(queue.take()->observations.empty());
  now += 5.0;  // where the silence was long, three messages agree before they are believed
  for (const double t : {0.0, 0.1, 0.2}) {
    load(now + t);
    frame(now + t);
  }
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(queue.take()->new_epoch);
  EXPECT_EQ(queue.broken_stamps(), 5U);
}

// A stamp that is ahead by less than a pause is believed. The next ones go back from it, and are no jump.
TEST_F(PatientFrameQueueTest, AStampThatIsALittleAheadIsNoJump) {
  start();
  for (const double t : {0.0, 0.1, 0.2, 0.3}) {
    load(t);
    frame(t);
    take();
  }
  load(1.2);
  for (const double t : {0.4, 0.5, 0.6, 0.7}) {
    load(t);
    frame(t);
    const auto work = queue.take();
    EXPECT_FALSE(work->new_epoch);
    EXPECT_NEAR((work->stamp - at(t)).toSec(), 0.0, 1e-9);
    EXPECT_EQ(work->loads.size(), t == 0.4 ? 2U : 1U);
  }
}

// The clock is set back while the frames are silent, by as much as they are: their stamps go on.
TEST_F(PatientFrameQueueTest, ATopicThatSleptThroughAJumpJoinsTheOthers) {
  start();
  for (double t = 0.0; t < 9.95; t += 0.1) load(t);
  for (double t = 0.0; t < 0.25; t += 0.1) frame(t);
  for (int k = 0; k < 3; ++k) take();
  for (double t = -5.0; t < 0.25; t += 0.1) load(t);
  for (const double t : {0.3, 0.4}) {
    load(t);
    frame(t);
  }
  const auto work = queue.take();
  EXPECT_TRUE(work->new_epoch);
  EXPECT_EQ(work->beginning, FrameQueue::Beginning::jump);
  EXPECT_NEAR((work->stamp - at(0.3)).toSec(), 0.0, 1e-9);
  EXPECT_GT(work->loads.size(), 50U);
}

// A load that comes now and then is believed where its stamp is that of the other topics.
TEST_F(PatientFrameQueueTest, AJumpOfOneTopicIsBelievedWhereAnotherOneAgrees) {
  start();
  for (double t = 0.0; t < 5.05; t += 0.1) frame(t);
  load(5.0);
  EXPECT_EQ(queue.take()->loads.size(), 1U);
  for (int k = 0; k < 2; ++k) take();
  EXPECT_EQ(queue.broken_stamps(), 0U);
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

// Nothing goes before the first message that could tell that its stamp is wrong.
TEST_F(PatientFrameQueueTest, ABrokenFirstStampIsLeftOut) {
  std::size_t broken = 0;
  for (const double jump : {3600.0, -3600.0, 5.0, -5.0}) {
    queue.restart();
    load(jump);
    frame(jump);
    for (const double t : {0.0, 0.1, 0.2}) {
      load(t);
      frame(t);
    }
    const auto work = queue.take();
    EXPECT_TRUE(work->new_epoch);
    EXPECT_NEAR((work->first_stamp - at(0.0)).toSec(), 0.0, 1e-9) << jump;
    EXPECT_NEAR((work->stamp - at(0.0)).toSec(), 0.0, 1e-9) << jump;
    EXPECT_EQ(queue.broken_stamps(), broken += 2) << jump;
  }
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

TEST_F(PatientFrameQueueTest, ASlowTopicHasNoBrokenStamps) {
  for (const double t : {0.0, 2.5, 5.0, 7.5}) frame(t);
  EXPECT_EQ(queue.waiting(), 3U);
  EXPECT_EQ(queue.dropped(), 1U);
  EXPECT_EQ(queue.broken_stamps(), 0U);
  EXPECT_NEAR(take(), 2.5, 1e-9);
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
