#pragma once

#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <boost/signals2/connection.hpp>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>

namespace tissue_stiffness {

/// Waits for transforms that another thread puts into a buffer. The buffer wakes it at each arrival. One thread may wait.
///
/// A tf2_ros::MessageFilter would hand out each message when its transform comes, and drop others. FrameQueue has to see
/// them all in the order of their arrival, because it finds the beginning of a run by that.
class TransformWait {
 public:
  using Clock = std::chrono::steady_clock;

  /// The buffer has to outlive this object.
  explicit TransformWait(tf2::BufferCore& buffer);

  /// Waits until `source` has a pose in `target` at `stamp`, but not beyond `end`, and not while ROS shuts down. Returns
  /// false if there is none then; `reason` says what is missing.
  bool wait(const std::string& target, const std::string& source, const ros::Time& stamp, Clock::time_point end,
            std::string& reason);

 private:
  tf2::BufferCore& buffer_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::size_t arrivals_ = 0;                       ///< of transforms, so far
  boost::signals2::scoped_connection connection_;  ///< last member, because its signal uses the ones above
};

}  // namespace tissue_stiffness
