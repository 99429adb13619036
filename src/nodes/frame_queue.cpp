#include "nodes/frame_queue.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

const ros::Duration kJumpBack(0.5);
const ros::Duration kJumpAhead(60.0);
constexpr std::chrono::seconds kIdle{1};
constexpr std::size_t kMostLoads = 100000;  // a load at 1 kHz without a frame for 100 s

}  // namespace

FrameQueue::FrameQueue(std::chrono::duration<double> patience, std::size_t capacity)
    : patience_(patience), capacity_(capacity) {}

void FrameQueue::expect(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  topics_[topic];
}

void FrameQueue::add_observation(const std::string& topic, const ros::Time& stamp, MakeObservation make) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Place where = place(topic, stamp);
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
  changed_.notify_one();
}

void FrameQueue::add_load(const std::string& topic, const ros::Time& stamp, MakeLoad make) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Place where = place(topic, stamp);
  if (where.first < taken_epoch_) return;
  loads_.emplace(where, std::move(make));
  if (loads_.size() > kMostLoads) loads_.erase(loads_.begin());
  changed_.notify_one();
}

// Returns the epoch that a message belongs to. When its topic's stamps jump, the topic enters the next epoch.
FrameQueue::Place FrameQueue::place(const std::string& name, const ros::Time& stamp) {
  Topic& topic = topics_[name];
  const auto epoch = epochs_.find(topic.epoch);
  if (!topic.seen) {
    topic = {true, newest_epoch_, stamp, stamp};
  } else if (stamp + kJumpBack < topic.last || (stamp <= topic.first && epoch->second.last > stamp) ||
             stamp > epoch->second.last + kJumpAhead) {
    if (topic.epoch == newest_epoch_) ++newest_epoch_;
    topic = {true, newest_epoch_, stamp, stamp};
  }
  topic.last = std::max(topic.last, stamp);
  const auto [span, is_new] = epochs_.try_emplace(topic.epoch, Span{stamp, stamp});
  span->second.first = std::min(span->second.first, stamp);
  span->second.last = std::max(span->second.last, stamp);
  return {topic.epoch, stamp};
}

bool FrameQueue::complete(const Place& frame) const {
  return std::all_of(topics_.begin(), topics_.end(), [&](const auto& entry) {
    const Topic& topic = entry.second;
    return topic.seen && Place(topic.epoch, topic.last) >= frame;
  });
}

std::optional<FrameQueue::Work> FrameQueue::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_) {
    if (std::exchange(woken_, false)) return Work();
    if (frames_.empty()) {
      if (changed_.wait_for(lock, kIdle) == std::cv_status::timeout) return Work();
      continue;
    }
    const auto& [place, frame] = *frames_.begin();
    const auto deadline = frame.arrival + std::chrono::duration_cast<Clock::duration>(patience_);
    if (complete(place) || Clock::now() >= deadline) return take_front();
    changed_.wait_until(lock, deadline);
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
    if (topic.seen) oldest = std::min(oldest, topic.epoch);
  }
  return oldest;
}

void FrameQueue::restart() {
  const std::lock_guard<std::mutex> lock(mutex_);
  dropped_ += frames_.size();
  frames_.clear();
  loads_.clear();
  for (auto& [name, topic] : topics_) topic.seen = false;
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

}  // namespace tissue_stiffness
