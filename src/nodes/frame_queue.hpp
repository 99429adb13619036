#pragma once

#include <ros/time.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nodes/stamp_filter.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// Orders the messages of several topics as the estimator needs them. Callbacks add messages, and one worker takes them.
///
/// A frame is handed out once every topic has delivered up to the frame's stamp, or after `patience`. In the latter case
/// the available messages are handed out. When more than `capacity` frames wait, the oldest is dropped.
///
/// An epoch is one run of the experiment. A topic starts a new epoch when its stamps go back by more than 0.5 s, or to the
/// topic's first stamp (a bag that loops), or ahead by more than a minute. Topics may notice this at different times, so
/// each message is kept in the epoch of its topic. A topic whose stamps had jumped alone joins the others again when its
/// stamps go on from theirs.
///
/// A message whose stamp jumps is held back until it is believed: three stamps of its topic agree (see StampFilter), or it
/// goes on from the believed stamps of another topic. Broken ones are left out. A silence makes the first message of all
/// believed, but no jump.
class FrameQueue {
 public:
  /// Conversions run in the worker, because they may wait for a transform. They may throw InputError.
  using MakeObservation = std::function<Observation()>;
  using MakeLoad = std::function<LoadSample()>;

  /// What is known of an epoch's beginning.
  enum class Beginning {
    stated,   ///< the first epoch, the one after restart(), a recording that begins again: it begins as the model says
    unknown,  ///< after a silence it may be another body, at stamps seen before the same data again; it need not be at rest
    jump      ///< a clock was set while messages kept coming: the same body goes on moving
  };

  /// The worker's next task. The loads of an epoch come with its first frame that needs them.
  struct Work {
    bool new_epoch = false;  ///< the estimator must be reset first
    Beginning beginning = Beginning::stated;
    ros::Time first_stamp;  ///< first stamp of the epoch, over all topics
    ros::Time stamp;
    std::vector<MakeLoad> loads;
    std::vector<MakeObservation> observations;
  };

  FrameQueue(std::chrono::duration<double> patience, std::size_t capacity);

  /// From now on frames wait for this topic.
  void expect(const std::string& topic);

  void add_observation(const std::string& topic, const ros::Time& stamp, MakeObservation make);
  void add_load(const std::string& topic, const ros::Time& stamp, MakeLoad make);

  /// Waits for the next frame. Returns nothing after stop(). Returns work without observations after wake(), and after a
  /// second without any.
  std::optional<Work> take();
  /// Makes take() return although no frame is available.
  void wake();

  /// Forgets all waiting messages. The next message starts a new epoch.
  void restart();
  void stop();

  std::size_t waiting() const;
  std::size_t dropped() const;
  /// Returns the number of messages that were left out for their stamps.
  std::size_t broken_stamps() const;
  /// Names topic and jump of the last one of them; empty: none.
  std::string last_broken_stamp() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Place = std::pair<int, ros::Time>;  ///< epoch and stamp
  using Put = std::function<void(const Place&)>;
  using Filter = StampFilter<Put>;
  struct Topic {
    int epoch = 0;
    std::size_t noted = 0;  ///< number of its messages left out, as of last_broken_
    Filter filter;
  };
  struct Span {
    ros::Time first, last;
    Beginning beginning;
  };
  struct Pending {
    Clock::time_point arrival;
    std::vector<MakeObservation> observations;
  };

  Topic& find_topic(const std::string& name);
  void accept(const std::string& name, const ros::Time& stamp, Put put);
  bool starts_over(const Topic& topic, const ros::Time& stamp) const;
  /// Believes held messages that go on from the stamps of other topics.
  void release_agreeing();
  void note_broken_stamps();
  bool agrees_with_others(const Topic& topic, const ros::Time& stamp) const;
  void put(Topic& topic, const std::vector<Filter::Stamped>& believed);
  /// Returns the epoch that a topic belongs to whose stamps go on: its own, or a later one of other topics.
  int rejoined(const Topic& topic, const ros::Time& stamp) const;
  Place place(Topic& topic, const ros::Time& stamp);
  Beginning beginning_of(const Topic& moved, const Filter::Stamped& first) const;
  /// Moves a topic whose stamps start over to the epoch that they belong to.
  void move(Topic& topic, const Filter::Stamped& first);
  /// Gives an epoch that was left the number of a new one, which begins with this stamp.
  void renew(int epoch, const ros::Time& stamp);
  /// Believes the first message of all after a silence. Returns when that has to be asked next.
  Clock::time_point release_first();
  bool complete(const Place& place) const;
  Work take_front();
  int oldest_epoch() const;

  const Clock::duration patience_;
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Topic> topics_;
  std::map<int, Span> epochs_;
  std::map<Place, Pending> frames_;
  std::multimap<Place, MakeLoad> loads_;
  ros::Time origin_;                                     ///< first stamp of the last epoch whose beginning is stated
  std::optional<std::pair<ros::Time, ros::Time>> seen_;  ///< first and last of all stamps since restart()
  int newest_epoch_ = 0;
  int taken_epoch_ = -1;
  std::size_t dropped_ = 0;
  std::string last_broken_;
  bool stopped_ = false, woken_ = false;
};

}  // namespace tissue_stiffness
