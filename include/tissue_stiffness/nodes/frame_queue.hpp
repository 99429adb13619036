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

/// Puts what arrives on several topics into the order in which the estimator needs it. Callbacks add, one worker takes.
///
/// A frame is handed out once every topic has delivered up to the frame's stamp, or after `patience`: then what has come
/// must do (a load is held). When more than `capacity` frames wait, the oldest is dropped.
///
/// A topic whose stamps jump back (by more than 0.5 s, or to where the topic began: a bag that loops), or ahead by more
/// than a minute, starts a new lap: another run of the experiment. Topics may notice at different times; each message is
/// kept in the lap of its topic.
class FrameQueue {
 public:
  /// Conversions run in the worker, because they may wait for a transform; they may throw InputError.
  using MakeObservation = std::function<Observation()>;
  using MakeLoad = std::function<LoadSample()>;

  /// What the worker does next. The loads of a lap come with its first frame that needs them.
  struct Work {
    bool new_lap = false;   ///< the estimator has to be reset before
    ros::Time first_stamp;  ///< of the lap, over all topics
    ros::Time stamp;
    std::vector<MakeLoad> loads;
    std::vector<MakeObservation> observations;
  };

  FrameQueue(std::chrono::duration<double> patience, std::size_t capacity);

  /// Frames wait for this topic from now on.
  void expect(const std::string& topic);

  void add_observation(const std::string& topic, const ros::Time& stamp, MakeObservation make);
  void add_load(const std::string& topic, const ros::Time& stamp, MakeLoad make);

  /// Waits for the next frame. Nothing after stop(); work without observations after wake(), and after a second without
  /// any.
  std::optional<Work> take();
  /// Lets take() return although no frame is there.
  void wake();

  /// Forgets what waits; the next message starts a new lap.
  void restart();
  void stop();

  std::size_t waiting() const;
  std::size_t dropped() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Place = std::pair<int, ros::Time>;  ///< lap and stamp
  struct Topic {
    bool seen = false;
    int lap = 0;
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
  int oldest_lap() const;

  const std::chrono::duration<double> patience_;
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Topic> topics_;
  std::map<int, Span> laps_;
  std::map<Place, Pending> frames_;
  std::multimap<Place, MakeLoad> loads_;
  int newest_lap_ = 0;
  int taken_lap_ = -1;
  std::size_t dropped_ = 0;
  bool stopped_ = false, woken_ = false;
};

}  // namespace tissue_stiffness
