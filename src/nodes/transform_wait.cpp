#include "nodes/transform_wait.hpp"

#include <ros/init.h>

#include <algorithm>

namespace tissue_stiffness {
namespace {

constexpr std::chrono::milliseconds kShutdownCheck{100};  // how soon a wait notices that ROS shuts down, which wakes nobody

}  // namespace

TransformWait::TransformWait(tf2::BufferCore& buffer)
    : buffer_(buffer), connection_(buffer._addTransformsChangedListener([this] {
        {
          const std::lock_guard<std::mutex> lock(mutex_);
          ++arrivals_;
        }
        arrived_.notify_all();
      })) {}

bool TransformWait::wait(const std::string& target, const std::string& source, const ros::Time& stamp,
                         Clock::time_point end, std::string& reason) {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    const std::size_t seen = arrivals_;  // noted before the buffer is asked, so that no arrival is missed
    lock.unlock();
    if (buffer_.canTransform(target, source, stamp, &reason)) return true;
    lock.lock();
    do {
      const Clock::time_point now = Clock::now();
      if (now >= end || ros::isShuttingDown()) return false;
      arrived_.wait_until(lock, std::min(end, now + kShutdownCheck), [&] { return arrivals_ != seen; });
    } while (arrivals_ == seen);
  }
}

}  // namespace tissue_stiffness
