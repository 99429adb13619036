// This file checks the stamps of a recording's topics: for topics that stopped, and for clocks that differ.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "check/check_topics.hpp"
#include "check/words.hpp"
#include "types/median.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kGaps = 10.0;     // of a topic's longest gap: a rate that wavers does not reach it
constexpr double kShare = 0.1;     // of the recording
constexpr double kPatience = 0.5;  // [s] a message may lag behind the newest stamp, in the reader too

std::string seconds(double value) {
  return plain_number(value) + " s";
}

double longest_gap(const std::vector<double>& times) {
  double longest = 0.0;
  for (std::size_t i = 1; i < times.size(); ++i) longest = std::max(longest, times[i] - times[i - 1]);
  return longest;
}

/// Returns the median of stamp - record time [s].
double lead(const TopicTimes& times) {
  std::vector<double> leads;
  for (std::size_t i = 0; i < times.stamps.size(); ++i) leads.push_back(times.stamps[i] - times.arrivals[i]);
  return median_of(std::move(leads));
}

/// Returns the time from the end of one topic to the start of the other [s]; it is negative where they overlap.
double apart(const TopicTimes& a, const TopicTimes& b) {
  const auto [first_a, last_a] = std::minmax_element(a.stamps.begin(), a.stamps.end());
  const auto [first_b, last_b] = std::minmax_element(b.stamps.begin(), b.stamps.end());
  return std::max(*first_b - *last_a, *first_a - *last_b);
}

}  // namespace

SetupFindings check_stops(const std::vector<TopicTimes>& topics) {
  double begin = std::numeric_limits<double>::infinity(), end = -begin;
  for (const TopicTimes& times : topics) {
    if (times.arrivals.empty()) continue;
    begin = std::min(begin, times.arrivals.front());
    end = std::max(end, times.arrivals.back());
  }
  SetupFindings findings;
  for (const TopicTimes& times : topics) {
    if (times.arrivals.size() < 2) continue;  // a constant is said once
    const double silence = end - times.arrivals.back();
    if (silence <= kGaps * longest_gap(times.arrivals) || silence <= kShare * (end - begin)) continue;
    findings.push_back({times.topic, times.topic + " stopped " + seconds(silence) + " before the other topics, after " +
                                         seconds(times.arrivals.back() - begin) + " of " + seconds(end - begin) +
                                         " with a longest gap of " + seconds(longest_gap(times.arrivals)) +
                                         " until then; look for a sensor or a driver that gave up, or cut the recording "
                                         "there."});
  }
  return findings;
}

SetupFindings check_clocks(const std::vector<TopicTimes>& topics) {
  SetupFindings findings;
  if (topics.empty() || topics.front().stamps.empty()) return findings;
  const TopicTimes& first = topics.front();
  const std::string mend = "; synchronise the clocks (chrony, PTP), or stamp both topics on one machine.";
  for (std::size_t i = 1; i < topics.size(); ++i) {
    const TopicTimes& other = topics[i];
    if (other.stamps.size() < 2) continue;  // a latched message may be older than the recording
    const double gap = apart(first, other), ahead = lead(other) - lead(first);
    if (gap > 0.0) {
      findings.push_back({other.topic, other.topic + ": its stamps and those of " + first.topic +
                                           " share no instant and are " + seconds(gap) +
                                           " apart, where they should overlap" + mend});
    } else if (std::abs(ahead) > kPatience) {
      findings.push_back({other.topic, other.topic + ": its stamps are " + seconds(std::abs(ahead)) +
                                           (ahead > 0.0 ? " ahead of" : " behind") + " those of " + first.topic +
                                           " that were recorded with them, and " + seconds(kPatience) +
                                           " is the most that is waited for" + mend});
    }
  }
  return findings;
}

}  // namespace tissue_stiffness
