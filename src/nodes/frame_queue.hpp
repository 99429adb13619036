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
/// A message whose stamp jumps is held back until it is believed (see StampFilter). Broken ones are left out. A silence
/// does not make a jump believed while other topics go on.
class FrameQueue {
 public:
  /// Conversions run in the worker, because they may wait for a transform. They may throw InputError.
  using MakeObservation = std::function<Observation()>;
  using MakeLoad = std::function<LoadSample()>;

  /// The worker's next task. The loads of an epoch come with its first frame that needs them.
  struct Work {
    bool new_epoch = false;  ///< the estimator must be reset first
    ros::Time first_stamp;   ///< first stamp of the epoch, over all topics
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
    Filter filter;
  };
  struct Span {
    ros::Time first, last;
  };
  struct Pending {
    Clock::time_point arrival;
    std::vector<MakeObservation> observations;
  };

  Topic& find_topic(const std::string& name);
  void accept(const std::string& name, const ros::Time& stamp, Put put);
  bool starts_over(const Topic& topic, const ros::Time& stamp) const;
  void put(Topic& topic, const std::vector<Filter::Stamped>& believed);
  Place place(Topic& topic, const ros::Time& stamp);
  /// Moves a topic whose stamps start over to the epoch that they belong to.
  void move(Topic& topic, const ros::Time& stamp);
  /// Gives an epoch that was left the number of a new one.
  void renew(int epoch);
  /// Returns whether other topics went on in this topic's epoch since its last message came.
  bool others_go_on(const Topic& jumped) const;
  /// Releases what no message has contradicted in time. Returns when that has to be asked next.
  Clock::time_point release_overdue();
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
  int newest_epoch_ = 0;
  int taken_epoch_ = -1;
  std::size_t dropped_ = 0;
  std::string last_broken_;
  bool stopped_ = false, woken_ = false;
};

}  // namespace tissue_stiffness
