#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <utility>

#include "nodes/frame_queue.hpp"

namespace tissue_stiffness {

using Seconds = std::chrono::duration<double>;

inline ros::Time at(double seconds) {
  return ros::Time(1e6 + seconds);
}

/// The tests feed a queue that keeps three frames, and that waits briefly for a load.
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

/// The queue waits for a load as long as it takes.
class PatientFrameQueueTest : public FrameQueueTest {
 protected:
  PatientFrameQueueTest() : FrameQueueTest(Seconds(1e6)) {}
};

}  // namespace tissue_stiffness
