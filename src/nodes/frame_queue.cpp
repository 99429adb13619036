#include "nodes/frame_queue.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

constexpr double kJumpAhead = 60.0;  // [s]
constexpr std::chrono::seconds kIdle{1};
constexpr std::size_t kMostLoads = 100000;  // a load at 1 kHz without a frame for 100 s

}  // namespace

FrameQueue::FrameQueue(std::chrono::duration<double> patience, std::size_t capacity)
    : patience_(std::chrono::duration_cast<Clock::duration>(patience)), capacity_(capacity) {}

void FrameQueue::expect(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  topics_[topic];
}

void FrameQueue::add_observation(const std::string& topic, const ros::Time& stamp, MakeObservation make) {
  const std::lock_guard<std::mutex> lock(mutex_);
  accept(topic, stamp, [this, make = std::move(make)](const Place& where) mutable {
    if (where.first < taken_epoch_) {
      ++dropped_;
      return;
    }
    const auto [frame, is_new] = frames_.try_emplace(where);
    if (is_new) frame->second.arrival = Clock::now();
    frame->second.observations.push_back(std::move(make));
    if (frames_.size() > capacity_) {
      frames_.erase(frames_.begin());
      ++dropped_;
    }
  });
  changed_.notify_one();
}

void FrameQueue::add_load(const std::string& topic, const ros::Time& stamp, MakeLoad make) {
  const std::lock_guard<std::mutex> lock(mutex_);
  accept(topic, stamp, [this, make = std::move(make)](const Place& where) mutable {
    if (where.first < taken_epoch_) return;
    loads_.emplace(where, std::move(make));
    if (loads_.size() > kMostLoads) loads_.erase(loads_.begin());
  });
  changed_.notify_one();
}

void FrameQueue::accept(const std::string& name, const ros::Time& stamp, Put put) {
  Topic& topic = topics_[name];
  if (!topic.stamps.seen) {
    topic.epoch = newest_epoch_;
  } else if (jumps(topic, stamp)) {
    if (!topic.held.empty() && goes_back(topic.held.back().stamp, stamp)) leave_out(name, topic);
    topic.held.push_back({stamp, Clock::now(), std::move(put)});
    if (topic.held.size() >= kAgreeingStamps) release(topic);
    return;
  }
  leave_out(name, topic);
  put(place(topic, stamp));
}

// Returns whether the topic's stamps begin anew with this one.
bool FrameQueue::starts_over(const Topic& topic, const ros::Time& stamp) const {
  const ros::Time newest = epochs_.at(topic.epoch).last;
  return topic.stamps.back(stamp) || (stamp <= topic.stamps.first && newest > stamp) ||
         seconds_between(newest, stamp) > kJumpAhead;
}

bool FrameQueue::jumps(const Topic& topic, const ros::Time& stamp) const {
  return starts_over(topic, stamp) || topic.stamps.ahead(stamp);
}

FrameQueue::Place FrameQueue::place(Topic& topic, const ros::Time& stamp) {
  topic.stamps.advance(stamp);
  const auto [span, is_new] = epochs_.try_emplace(topic.epoch, Span{stamp, stamp});
  span->second.first = std::min(span->second.first, stamp);
  span->second.last = std::max(span->second.last, stamp);
  return {topic.epoch, stamp};
}

void FrameQueue::release(Topic& topic) {
  const std::vector<Held> held = std::exchange(topic.held, {});
  if (starts_over(topic, held.front().stamp)) {
    if (topic.epoch == newest_epoch_) ++newest_epoch_;
    topic = {newest_epoch_, {false, {}, {}, topic.stamps.interval}, {}};
  }
  for (const Held& message : held) message.put(place(topic, message.stamp));
}

void FrameQueue::leave_out(const std::string& name, Topic& topic) {
  for (const Held& message : topic.held) {
    last_broken_ = topic.stamps.jump_to(message.stamp, name);
    ++broken_;
  }
  topic.held.clear();
}

FrameQueue::Clock::time_point FrameQueue::release_overdue() {
  Clock::time_point next = Clock::now() + kIdle;
  for (auto& [name, topic] : topics_) {
    if (topic.held.empty()) continue;
    const Clock::time_point due = topic.held.back().arrival + patience_;
    if (due <= Clock::now()) {
      release(topic);
    } else {
      next = std::min(next, due);
    }
  }
  return next;
}

bool FrameQueue::complete(const Place& frame) const {
  return std::all_of(topics_.begin(), topics_.end(), [&](const auto& entry) {
    const Topic& topic = entry.second;
    return topic.stamps.seen && Place(topic.epoch, topic.stamps.last) >= frame;
  });
}

std::optional<FrameQueue::Work> FrameQueue::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  const Clock::time_point idle = Clock::now() + kIdle;
  while (!stopped_) {
    if (std::exchange(woken_, false)) return Work();
    const Clock::time_point next = release_overdue();
    if (frames_.empty()) {
      if (Clock::now() >= idle) return Work();
      changed_.wait_until(lock, std::min(idle, next));
      continue;
    }
    const auto& [place, frame] = *frames_.begin();
    const auto deadline = frame.arrival + patience_;
    if (complete(place) || Clock::now() >= deadline) return take_front();
    changed_.wait_until(lock, std::min(deadline, next));
  }
  return std::nullopt;
}

FrameQueue::Work FrameQueue::take_front() {
  const auto front = frames_.begin();
  const int epoch = front->first.first;
  Work work;
  work.new_epoch = epoch != taken_epoch_;
  work.first_stamp = epochs_.at(epoch).first;
  work.stamp = front->first.second;
  work.observations = std::move(front->second.observations);
  frames_.erase(front);
  // Samples later than the frame are included, because the estimator interpolates up to the next one.
  const auto end = loads_.lower_bound(Place(epoch + 1, ros::Time()));
  for (auto load = loads_.begin(); load != end; ++load) {
    if (load->first.first == epoch) work.loads.push_back(std::move(load->second));
  }
  loads_.erase(loads_.begin(), end);
  epochs_.erase(epochs_.begin(), epochs_.lower_bound(std::min(epoch, oldest_epoch())));
  taken_epoch_ = epoch;
  return work;
}

int FrameQueue::oldest_epoch() const {
  int oldest = newest_epoch_;
  for (const auto& [name, topic] : topics_) {
    if (topic.stamps.seen) oldest = std::min(oldest, topic.epoch);
  }
  return oldest;
}

void FrameQueue::restart() {
  const std::lock_guard<std::mutex> lock(mutex_);
  dropped_ += frames_.size();
  frames_.clear();
  loads_.clear();
  for (auto& [name, topic] : topics_) topic = {};
  ++newest_epoch_;
}

void FrameQueue::wake() {
  const std::lock_guard<std::mutex> lock(mutex_);
  woken_ = true;
  changed_.notify_all();
}

void FrameQueue::stop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

std::size_t FrameQueue::waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return frames_.size();
}

std::size_t FrameQueue::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

std::size_t FrameQueue::broken_stamps() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return broken_;
}

std::string FrameQueue::last_broken_stamp() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_broken_;
}

}  // namespace tissue_stiffness
