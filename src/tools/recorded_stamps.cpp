#include "tools/recorded_stamps.hpp"

#include <algorithm>
#include <utility>

namespace tissue_stiffness {
namespace {

constexpr double kPatience = 0.25;  // [s] least silence that makes a stamp believed; less than a message may lag

}  // namespace

void RecordedStamps::accept(const std::string& topic, const ros::Time& stamp, Put put) {
  Filter& filter = filters_.try_emplace(topic, kPatience).first->second;
  const std::size_t left_out = filter.left_out();
  believe(filter, filter.add(stamp, std::move(put), now_));
  if (filter.left_out() > left_out) last_broken_ = topic + ": " + filter.last_left_out();
  release_agreeing();
}

void RecordedStamps::believe(Filter& filter, const std::vector<Filter::Stamped>& believed) {
  for (const Filter::Stamped& message : believed) {
    filter.advance(message.stamp);
    message.message();
  }
}

// Held messages are believed where they go on from the stamps of another topic.
void RecordedStamps::release_agreeing() {
  for (auto& [name, filter] : filters_) {
    if (!filter.holds()) continue;
    const auto agrees = [&, &own = filter](const ros::Time& stamp) {
      return std::any_of(filters_.begin(), filters_.end(), [&](const auto& other) {
        const Filter& filter = other.second;
        const bool silent = own.stamps().seen && filter.silent_from() < now_;
        return &filter != &own && filter.stamps().seen && !silent && filter.stamps().go_on_with(stamp);
      });
    };
    const std::size_t left_out = filter.left_out();
    believe(filter, filter.release_if(agrees));
    if (filter.left_out() > left_out) last_broken_ = name + ": " + filter.last_left_out();
  }
}

// Two messages cannot agree as three would, so those of such a topic are believed after a silence. So is the first message
// of all.
void RecordedStamps::advance(double now) {
  now_ = now;
  const bool any_seen =
      std::any_of(filters_.begin(), filters_.end(), [](const auto& filter) { return filter.second.stamps().seen; });
  for (auto& [name, filter] : filters_) {
    if (!filter.holds() || filter.stamps().seen || filter.silent_from() > now_) continue;
    if (!any_seen || count_(name) < kAgreeingStamps) believe(filter, filter.release());
  }
}

// A topic's only messages have none to be judged by; a jump at the end has none that agree.
void RecordedStamps::finish() {
  for (auto& [name, filter] : filters_) {
    if (!filter.holds()) continue;
    if (!filter.stamps().seen) {
      believe(filter, filter.release());
      continue;
    }
    filter.leave_out_held();
    last_broken_ = name + ": " + filter.last_left_out();
  }
}

int RecordedStamps::broken() const {
  std::size_t out = 0;
  for (const auto& [name, filter] : filters_) out += filter.left_out();
  return static_cast<int>(out);
}

}  // namespace tissue_stiffness
