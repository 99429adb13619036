#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "nodes/topic_stamps.hpp"

namespace tissue_stiffness {

/// Decides which stamps of one topic are believed, and holds back the messages of the others.
///
/// A clock that jumps stamps many messages, and a broken stamp is alone. So a stamp is believed when it goes on from the
/// believed ones or when three held stamps agree. A silence of the topic makes none believed. The first messages of a topic
/// go on from none, so they are held too. The caller may believe held ones that agree with what it knows of other topics.
///
/// Times of arrival are in seconds, on whatever clock the caller has: the wall's, or that of a bag.
template <typename Message>
class StampFilter {
 public:
  /// `patience`: a shorter pause between two messages is no silence [s].
  explicit StampFilter(double patience = 0.0) : patience_(patience) {}

  struct Stamped {
    ros::Time stamp;
    Message message;
    bool after_silence;  ///< the topic had been silent for longer than usual when the message arrived
    bool restarts;       ///< the topic's stamps begin anew with this one or a held one before
  };
  const TopicStamps& stamps() const { return stamps_; }

  /// Adds a message that arrives `now`. Returns the messages that are believed thereby, in order. `restarts`: the caller
  /// knows that the topic's stamps begin anew with this one.
  std::vector<Stamped> add(const ros::Time& stamp, Message message, double now, bool restarts = false) {
    const bool after_silence = (stamps_.seen || holds()) && now > silent_from();
    const bool again = restarts || goes_on_restarting(stamp);
    note_arrival(now);
    if (stamps_.seen && !again && stamps_.go_on_with(stamp)) {
      leave_out_held();
      return {{stamp, std::move(message), after_silence, again}};
    }
    leave_out_contradicted(stamp);
    held_.push_back({stamp, std::move(message), after_silence, again});
    const std::size_t agreeing = count_agreeing();
    while (held_.size() > (agreeing >= kAgreeingStamps ? agreeing : kMostHeld)) leave_out(0, stamp);
    return agreeing >= kAgreeingStamps ? release() : std::vector<Stamped>{};
  }

  bool holds() const { return !held_.empty(); }
  /// Returns when the topic has been silent for longer than usual.
  double silent_from() const {
    return last_arrival_ + std::max(patience_, kPauses * std::max(arrival_interval_, stamps_.interval));
  }
  /// Believes what is held.
  std::vector<Stamped> release() { return std::exchange(held_, {}); }
  /// Believes the held messages whose stamps `agree`, and leaves out the others. Does nothing where none agrees.
  template <typename Agree>
  std::vector<Stamped> release_if(const Agree& agree) {
    const auto agreeing = std::find_if(held_.begin(), held_.end(), [&](const Stamped& m) { return agree(m.stamp); });
    if (agreeing == held_.end()) return {};
    const ros::Time next = agreeing->stamp;
    for (std::size_t k = held_.size(); k-- > 0;) {
      if (!agree(held_[k].stamp)) leave_out(k, next);
    }
    return release();
  }

  /// Goes on with the stamp of a believed message.
  void advance(const ros::Time& stamp) { stamps_.advance(stamp); }
  /// Forgets the stamps but not the interval.
  void start_over() { stamps_ = {false, {}, {}, stamps_.interval, {}}; }
  /// Forgets everything but what was left out.
  void forget() {
    stamps_ = {};
    held_.clear();
    arrival_interval_ = 0.0;
  }

  /// Leaves out the held messages of a topic whose stamps are known.
  void leave_out_held() {
    while (!held_.empty()) leave_out(0, stamps_.last);
  }
  std::size_t left_out() const { return left_out_; }
  /// Says how far the last one was off: "3 s ahead".
  const std::string& last_left_out() const { return last_left_out_; }

 private:
  void note_arrival(double now) {
    // A recording may be replayed slowly, so the stamps alone do not tell how long a silence is usual.
    if (stamps_.seen || !held_.empty()) arrival_interval_ = smooth_interval(arrival_interval_, now - last_arrival_);
    last_arrival_ = now;
  }
  // A recording that begins again may be so short that its stamps also go on from the last one.
  bool goes_on_restarting(const ros::Time& stamp) const {
    return holds() && held_.back().restarts && stamp <= stamps_.last &&
           goes_on(held_.back().stamp, stamp, stamps_.interval);
  }
  // Two stamps that contradict each other do not tell which of them is broken; the next one does.
  void leave_out_contradicted(const ros::Time& next) {
    const auto agrees = [&](const Stamped& held) { return goes_on(held.stamp, next, stamps_.interval); };
    if (std::none_of(held_.begin(), held_.end(), agrees)) return;
    for (std::size_t k = held_.size(); k-- > 0;) {
      if (!agrees(held_[k])) leave_out(k, next);
    }
  }
  // `next`: a stamp to tell the jump by where none was believed before.
  void leave_out(std::size_t k, const ros::Time& next) {
    last_left_out_ = jump(stamps_.seen ? stamps_.last : next, held_[k].stamp);
    ++left_out_;
    held_.erase(held_.begin() + static_cast<std::ptrdiff_t>(k));
  }

  // Returns how many of the last held stamps go on from one another. Where no interval is known, they are evenly spaced.
  std::size_t count_agreeing() const {
    double least = kJumpAhead, largest = 0.0;
    std::size_t count = 1;
    for (; count < held_.size(); ++count) {
      const ros::Time &to = held_[held_.size() - count].stamp, &from = held_[held_.size() - count - 1].stamp;
      least = std::min(least, seconds_between(from, to));
      largest = std::max(largest, seconds_between(from, to));
      const bool even = stamps_.interval > 0.0 || largest <= std::max(kPause, kPauses * least);
      if (!goes_on(from, to, stamps_.interval) || !even) break;
    }
    return count;
  }

  static constexpr std::size_t kMostHeld = 2 * kAgreeingStamps;

  double patience_;
  TopicStamps stamps_;
  std::vector<Stamped> held_;
  double last_arrival_ = 0.0, arrival_interval_ = 0.0;  // [s]
  std::size_t left_out_ = 0;
  std::string last_left_out_;
};

}  // namespace tissue_stiffness
