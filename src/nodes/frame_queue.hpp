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

#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// Orders the messages of several topics as the estimator needs them. Callbacks add messages, and one worker takes them.
///
/// A frame is handed out once every topic has delivered up to the frame's stamp, or after `patience`. In the latter case
/// the available messages are used (a load is held). When more than `capacity` frames wait, the oldest is dropped.
///
/// An epoch is one run of the experiment. A topic starts a new epoch when its stamps go back by more than 0.5 s, or to the
/// topic's first stamp (a bag that loops), or ahead by more than a minute. Topics may notice this at different times, so
/// each message is kept in the epoch of its topic.
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

 private:
  using Clock = std::chrono::steady_clock;
  using Place = std::pair<int, ros::Time>;  ///< epoch and stamp
  struct Topic {
    bool seen = false;
    int epoch = 0;
    ros::Time first, last;
  };
  struct Span {
    ros::Time first, last;
  };
  struct Pending {
    Clock::time_point arrival;
    std::vector<MakeObservation> observations;
  };

  Place place(const std::string& topic, const ros::Time& stamp);
  bool complete(const Place& place) const;
  Work take_front();
  int oldest_epoch() const;

  const std::chrono::duration<double> patience_;
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
  bool stopped_ = false, woken_ = false;
};

}  // namespace tissue_stiffness
