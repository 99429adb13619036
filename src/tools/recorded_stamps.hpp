#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "nodes/stamp_filter.hpp"

namespace tissue_stiffness {

/// Holds back the messages of a recording until their stamps are believed, topic by topic (see StampFilter). A message
/// whose stamp is never believed is left out and counted.
class RecordedStamps {
 public:
  using Put = std::function<void()>;

  /// `count` returns how many messages the recording has on a topic.
  explicit RecordedStamps(std::function<std::size_t(const std::string&)> count) : count_(std::move(count)) {}

  /// Goes on to the instant at which the recorder received the next message [s], and releases what waited long enough.
  void advance(double now);
  /// Calls `put` once the stamp is believed.
  void accept(const std::string& topic, const ros::Time& stamp, Put put);
  /// Decides on all messages that are still held, at the end of the recording.
  void finish();

  /// Returns the number of messages that were left out.
  int broken() const;
  /// Names topic and jump of the last one of them; empty: none.
  const std::string& last_broken() const { return last_broken_; }

 private:
  using Filter = StampFilter<Put>;

  void believe(Filter& filter, const std::vector<Filter::Stamped>& believed);
  void release_agreeing();

  std::function<std::size_t(const std::string&)> count_;
  double now_ = 0.0;
  std::map<std::string, Filter> filters_;
  std::string last_broken_;
};

}  // namespace tissue_stiffness
