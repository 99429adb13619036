// What a topic stamps wrongly joins no frame, be it one message or many, and its later messages join the others again.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "frame_queue_test.hpp"

namespace tissue_stiffness {
namespace {

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

TEST_F(PatientFrameQueueTest, ASlowTopicHasNoBrokenStamps) {
  for (const double t : {0.0, 2.5, 5.0, 7.5}) frame(t);
  EXPECT_EQ(queue.waiting(), 3U);
  EXPECT_EQ(queue.dropped(), 1U);
  EXPECT_EQ(queue.broken_stamps(), 0U);
  EXPECT_NEAR(take(), 2.5, 1e-9);
}

}  // namespace
}  // namespace tissue_stiffness
