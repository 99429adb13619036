#include "nodes/frame_queue.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

constexpr std::chrono::seconds kIdle{1};
constexpr std::size_t kMostLoads = 100000;  // a load at 1 kHz without a frame for 100 s

double seconds(std::chrono::steady_clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

}  // namespace

FrameQueue::FrameQueue(std::chrono::duration<double> patience, std::size_t capacity)
    : patience_(std::chrono::duration_cast<Clock::duration>(patience)), capacity_(capacity) {}

void FrameQueue::expect(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  find_topic(topic);
}

FrameQueue::Topic& FrameQueue::find_topic(const std::string& name) {
  return topics_.try_emplace(name, Topic{0, 0, Filter(std::chrono::duration<double>(patience_).count())}).first->second;
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
  Topic& topic = find_topic(name);
  const bool restarts = topic.filter.stamps().seen && starts_over(topic, stamp);
  this->put(topic, topic.filter.add(stamp, std::move(put), seconds(Clock::now()), restarts));
  release_agreeing();
}

// Each topic that is believed thereby may be what another one waits for.
void FrameQueue::release_agreeing() {
  for (bool more = true; more;) {
    more = false;
    for (auto& [name, topic] : topics_) {
      if (!topic.filter.holds()) continue;
      const auto believed = topic.filter.release_if(
          [&, &jumped = topic](const ros::Time& stamp) { return agrees_with_others(jumped, stamp); });
      put(topic, believed);
      more = more || !believed.empty();
    }
  }
  note_broken_stamps();
}

// In its own epoch a stamp that starts over agrees with no topic that has not.
bool FrameQueue::agrees_with_others(const Topic& topic, const ros::Time& stamp) const {
  const bool seen = topic.filter.stamps().seen, restarts = seen && starts_over(topic, stamp);
  const double now = seconds(Clock::now());
  return std::any_of(topics_.begin(), topics_.end(), [&](const auto& entry) {
    const Topic& other = entry.second;
    if (&other == &topic || !other.filter.stamps().seen || (seen && other.filter.silent_from() < now)) return false;
    return (!seen || other.epoch > topic.epoch || !restarts) && other.filter.stamps().go_on_with(stamp);
  });
}

void FrameQueue::note_broken_stamps() {
  for (auto& [name, topic] : topics_) {
    if (topic.filter.left_out() == topic.noted) continue;
    topic.noted = topic.filter.left_out();
    last_broken_ = name + ": " + topic.filter.last_left_out();
  }
}

// Returns whether the topic's stamps begin anew with this one.
bool FrameQueue::starts_over(const Topic& topic, const ros::Time& stamp) const {
  const TopicStamps& stamps = topic.filter.stamps();
  const ros::Time newest = epochs_.at(topic.epoch).last;
  return stamps.start_over_with(stamp) || (stamp <= stamps.first && newest > stamp) ||
         seconds_between(newest, stamp) > kJumpAhead;
}

void FrameQueue::put(Topic& topic, const std::vector<Filter::Stamped>& believed) {
  if (believed.empty()) return;
  if (!topic.filter.stamps().seen) {
    topic.epoch = newest_epoch_;
  } else if (starts_over(topic, believed.front().stamp)) {
    move(topic, believed.front());
    topic.filter.start_over();
  } else {
    topic.epoch = rejoined(topic, believed.front().stamp);
  }
  for (const Filter::Stamped& message : believed) message.message(place(topic, message.stamp));
}

// A clock may have jumped while this topic was silent, by as much as the silence was long. Then its stamps go on from its
// own last one and from those of the others in a later epoch. The others have gone on for a while there, because a
// recording may also have begun again for them alone so far.
int FrameQueue::rejoined(const Topic& topic, const ros::Time& stamp) const {
  int epoch = topic.epoch;
  for (const auto& [name, other] : topics_) {
    const TopicStamps& stamps = other.filter.stamps();
    if (other.epoch <= epoch || !stamps.seen || !stamps.go_on_with(stamp)) continue;
    if (seconds_between(epochs_.at(other.epoch).first, stamp) > kPause) epoch = other.epoch;
  }
  return epoch;
}

FrameQueue::Place FrameQueue::place(Topic& topic, const ros::Time& stamp) {
  topic.filter.advance(stamp);
  const auto [span, is_new] = epochs_.try_emplace(topic.epoch, Span{stamp, stamp, Beginning::stated});
  if (!seen_) seen_ = {stamp, stamp};
  *seen_ = {std::min(seen_->first, stamp), std::max(seen_->second, stamp)};
  span->second.first = std::min(span->second.first, stamp);
  span->second.last = std::max(span->second.last, stamp);
  if (span->second.beginning == Beginning::stated) origin_ = span->second.first;
  return {topic.epoch, stamp};
}

void FrameQueue::move(Topic& moved, const Filter::Stamped& first) {
  const double now = seconds(Clock::now());
  for (const auto& [name, topic] : topics_) {
    const TopicStamps& stamps = topic.filter.stamps();
    if (&topic == &moved || !stamps.seen || topic.filter.silent_from() < now || !stamps.go_on_with(first.stamp)) continue;
    if (topic.epoch < taken_epoch_) renew(topic.epoch, first.stamp);
    moved.epoch = topic.epoch;
    return;
  }
  if (moved.epoch == newest_epoch_) {
    const Beginning beginning = beginning_of(moved, first);
    // The rest was at the recording's first stamp, even if that message did not come again.
    const ros::Time begin = beginning == Beginning::stated ? std::min(origin_, first.stamp) : first.stamp;
    epochs_[++newest_epoch_] = {begin, first.stamp, beginning};
  }
  moved.epoch = newest_epoch_;
}

FrameQueue::Beginning FrameQueue::beginning_of(const Topic& moved, const Filter::Stamped& first) const {
  const double late = seconds_between(origin_, first.stamp);
  const bool again = !goes_back(origin_, first.stamp) && late <= kPauses * moved.filter.stamps().interval;
  if (again) return Beginning::stated;
  const bool repeated = seen_ && first.stamp >= seen_->first && first.stamp <= seen_->second;
  return repeated || first.after_silence ? Beginning::unknown : Beginning::jump;
}

void FrameQueue::renew(int epoch, const ros::Time& stamp) {
  ++newest_epoch_;
  for (auto& [name, topic] : topics_) {
    if (topic.epoch == epoch) topic.epoch = newest_epoch_;
  }
  epochs_[newest_epoch_] = {stamp, std::max(stamp, epochs_.at(epoch).last), Beginning::jump};
  const auto from = loads_.lower_bound(Place(epoch, ros::Time())), to = loads_.lower_bound(Place(epoch + 1, ros::Time()));
  std::vector<std::pair<Place, MakeLoad>> kept;
  for (auto load = from; load != to; ++load) {
    kept.emplace_back(Place(newest_epoch_, load->first.second), std::move(load->second));
  }
  loads_.erase(from, to);
  for (auto& load : kept) loads_.insert(std::move(load));
}

// Nothing tells whether the first message of all is broken, and there may be no second one.
FrameQueue::Clock::time_point FrameQueue::release_first() {
  const Clock::time_point now = Clock::now();
  double next = seconds(now + kIdle);
  const bool any_seen =
      std::any_of(topics_.begin(), topics_.end(), [](const auto& entry) { return entry.second.filter.stamps().seen; });
  for (auto& [name, topic] : topics_) {
    if (any_seen || !topic.filter.holds()) continue;
    if (topic.filter.silent_from() <= seconds(now)) {
      put(topic, topic.filter.release());
      release_agreeing();
      return now;
    }
    next = std::min(next, topic.filter.silent_from());
  }
  return now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(next - seconds(now)));
}

bool FrameQueue::complete(const Place& frame) const {
  return std::all_of(topics_.begin(), topics_.end(), [&](const auto& entry) {
    const Topic& topic = entry.second;
    return topic.filter.stamps().seen && Place(topic.epoch, topic.filter.stamps().last) >= frame;
  });
}

std::optional<FrameQueue::Work> FrameQueue::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  const Clock::time_point idle = Clock::now() + kIdle;
  while (!stopped_) {
    if (std::exchange(woken_, false)) return Work();
    const Clock::time_point next = release_first();
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
  work.beginning = epochs_.at(epoch).beginning;
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
    if (topic.filter.stamps().seen) oldest = std::min(oldest, topic.epoch);
  }
  return oldest;
}

void FrameQueue::restart() {
  const std::lock_guard<std::mutex> lock(mutex_);
  dropped_ += frames_.size();
  frames_.clear();
  loads_.clear();
  for (auto& [name, topic] : topics_) topic.filter.forget();
  seen_.reset();
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
  std::size_t out = 0;
  for (const auto& [name, topic] : topics_) out += topic.filter.left_out();
  return out;
}

std::string FrameQueue::last_broken_stamp() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_broken_;
}

}  // namespace tissue_stiffness
