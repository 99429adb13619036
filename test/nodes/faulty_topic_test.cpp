#include "nodes/faulty_topic.hpp"

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kStart = 1000.0;    // [s]
constexpr double kInterval = 0.005;  // [s]

MessageBytes message_at(double seconds) {
  geometry_msgs::WrenchStamped message;
  message.header.stamp = ros::Time(kStart + seconds);
  MessageBytes bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

double stamp_of(const MessageBytes& message) {
  return read_header(message).stamp.toSec() - kStart;
}

FaultSettings only(Fault fault, double rate) {
  FaultSettings out;
  out.rates = {{fault, rate}};
  return out;
}

/// What a topic passed on, and the faults on the way.
struct Course {
  std::vector<double> stamps;
  std::vector<InjectedFault> faults;
};

Course run(FaultyTopic& topic, int messages, double interval = kInterval) {
  Course course;
  for (int k = 0; k < messages; ++k) {
    FaultyTopic::Passed passed = topic.pass(message_at(k * interval));
    for (const MessageBytes& message : passed.messages) course.stamps.push_back(stamp_of(message));
    if (passed.fault) course.faults.push_back(*passed.fault);
  }
  return course;
}

Course run(const FaultSettings& settings, int messages) {
  FaultyTopic topic(settings, "geometry_msgs/WrenchStamped", 0);
  return run(topic, messages);
}

TEST(FaultyTopic, WithoutFaultsIsARelay) {
  const Course course = run(FaultSettings(), 100);
  ASSERT_EQ(course.stamps.size(), 100U);
  EXPECT_TRUE(course.faults.empty());
  EXPECT_NEAR(course.stamps[99], 99 * kInterval, 1e-6);
}

TEST(FaultyTopic, ASeedMakesTheSameFaultsAgain) {
  FaultSettings settings;
  for (const Fault fault : {Fault::drop, Fault::delay, Fault::duplicate, Fault::reorder, Fault::restamp, Fault::mute}) {
    settings.rates[fault] = 0.05;
  }
  const Course one = run(settings, 2000), same = run(settings, 2000);
  EXPECT_EQ(one.stamps, same.stamps);
  EXPECT_EQ(one.faults, same.faults);
  settings.seed = 2;
  EXPECT_NE(run(settings, 2000).stamps, one.stamps);
  settings.seed = 1;
  FaultyTopic second(settings, "geometry_msgs/WrenchStamped", 1);
  EXPECT_NE(run(second, 2000).stamps, one.stamps);
}

TEST(FaultyTopic, DropsAtTheRate) {
  const Course course = run(only(Fault::drop, 0.1), 10000);
  EXPECT_EQ(course.stamps.size() + course.faults.size(), 10000U);
  EXPECT_NEAR(double(course.faults.size()), 1000.0, 4 * std::sqrt(900.0));
  EXPECT_EQ(course.faults.front().fault, "drop");
  EXPECT_NEAR(course.faults.front().header.stamp.toSec() - kStart, double(course.faults.front().number) * kInterval, 1e-6);
}

TEST(FaultyTopic, DuplicatesFollowEachOther) {
  const Course course = run(only(Fault::duplicate, 1.0), 3);
  EXPECT_EQ(course.stamps.size(), 6U);
  EXPECT_EQ(course.stamps[0], course.stamps[1]);
  EXPECT_LT(course.stamps[1], course.stamps[2]);
}

TEST(FaultyTopic, AReorderedMessageComesAfterTheNext) {
  const Course course = run(only(Fault::reorder, 0.1), 1000);
  ASSERT_FALSE(course.faults.empty());
  for (std::size_t k = 1; k < course.stamps.size(); ++k) {
    const auto number = std::lround(course.stamps[k] / kInterval);
    const bool reordered = std::any_of(course.faults.begin(), course.faults.end(),
                                       [&](const InjectedFault& fault) { return long(fault.number) == number; });
    if (course.stamps[k] < course.stamps[k - 1]) {
      EXPECT_TRUE(reordered) << number;
    }
  }
  EXPECT_GE(course.stamps.size(), 999U);  // the last one may still wait
  EXPECT_FALSE(std::is_sorted(course.stamps.begin(), course.stamps.end()));
}

TEST(FaultyTopic, ADelayedMessageComesWhenItsTimeIsOver) {
  FaultSettings settings = only(Fault::delay, 0.1);
  settings.longest_delay = 0.2;
  FaultyTopic topic(settings, "", 0);
  std::vector<double> arrivals(400, -1.0);
  std::vector<InjectedFault> faults;
  for (int k = 0; k < 400; ++k) {
    const FaultyTopic::Passed passed = topic.pass(message_at(k * kInterval));
    for (const MessageBytes& message : passed.messages) {
      arrivals[std::size_t(std::lround(stamp_of(message) / kInterval))] = k * kInterval;
    }
    if (passed.fault) faults.push_back(*passed.fault);
  }
  ASSERT_GT(faults.size(), 10U);
  for (const InjectedFault& fault : faults) {
    const double due = double(fault.number) * kInterval + fault.seconds;
    EXPECT_LE(fault.seconds, 0.2);
    if (due > 399 * kInterval) continue;
    EXPECT_GE(arrivals[fault.number], due - 1e-6);
    EXPECT_LE(arrivals[fault.number], due + kInterval + 1e-6);
  }
}

TEST(FaultyTopic, AMuteSwallowsAllMessagesUntilItsEnd) {
  FaultSettings settings = only(Fault::mute, 0.5);
  settings.longest_mute = 1.0;
  const Course course = run(settings, 4000);
  ASSERT_GT(course.faults.size(), 3U);
  for (const InjectedFault& fault : course.faults) {
    const double from = fault.header.stamp.toSec() - kStart, to = from + fault.seconds;
    EXPECT_LE(fault.seconds, 1.0);
    for (const double stamp : course.stamps) EXPECT_FALSE(stamp > from - 1e-6 && stamp < to - 1e-6) << stamp;
  }
  for (std::size_t k = 1; k < course.faults.size(); ++k) {
    EXPECT_GT(course.faults[k].header.stamp,
              course.faults[k - 1].header.stamp + ros::Duration(course.faults[k - 1].seconds) - ros::Duration(1e-6));
  }
}

TEST(FaultyTopic, RestampsSecondsAheadAndBackAndAnHourAhead) {
  FaultSettings settings = only(Fault::restamp, 1.0);
  settings.longest_shift = 4.0;
  const Course course = run(settings, 300);
  int ahead = 0, back = 0, hours = 0;
  for (std::size_t k = 0; k < 300; ++k) {
    const double shift = course.stamps[k] - double(k) * kInterval;
    EXPECT_NEAR(shift, course.faults[k].seconds, 1e-6);
    if (shift > 3000.0) {
      EXPECT_NEAR(shift, 3600.0, 1e-6);
      ++hours;
    } else {
      EXPECT_LE(std::abs(shift), 4.0);
      ++(shift > 0.0 ? ahead : back);
    }
  }
  EXPECT_GT(std::min({ahead, back, hours}), 60);
}

TEST(FaultyTopic, TellsWhatItCorrupted) {
  FaultyTopic topic(only(Fault::corrupt, 1.0), "geometry_msgs/WrenchStamped", 0);
  const FaultyTopic::Passed passed = topic.pass(message_at(0.0));
  ASSERT_TRUE(passed.fault);
  EXPECT_EQ(passed.fault->fault, "corrupt");
  EXPECT_FALSE(passed.fault->detail.empty());
  ASSERT_EQ(passed.messages.size(), 1U);
  EXPECT_NE(passed.messages.front(), message_at(0.0));
}

TEST(FaultyTopic, QuietTimesHaveNoFaults) {
  FaultSettings settings = only(Fault::drop, 0.5);
  settings.active = 1.0;
  settings.quiet = 3.0;
  const Course course = run(settings, 4000);
  ASSERT_GT(course.faults.size(), 100U);
  for (const InjectedFault& fault : course.faults) EXPECT_GE(std::fmod(fault.header.stamp.toSec(), 4.0), 3.0);
}

TEST(FaultyTopic, WhatIsHeldComesWhenTheRecordingBeginsAgain) {
  FaultSettings settings = only(Fault::delay, 1.0);
  settings.longest_delay = 60.0;
  FaultyTopic topic(settings, "", 0);
  EXPECT_TRUE(topic.pass(message_at(10.0)).messages.empty());
  const auto released = topic.pass(message_at(0.0)).messages;
  ASSERT_EQ(released.size(), 1U);
  EXPECT_NEAR(stamp_of(released.front()), 10.0, 1e-6);
  EXPECT_EQ(topic.release().size(), 1U);
  EXPECT_TRUE(topic.release().empty());
}

}  // namespace
}  // namespace tissue_stiffness
