#include "nodes/load_silence.hpp"

#include <algorithm>
#include <cstddef>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <vector>

#include "nodes/topic_stamps.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kFewest = 3, kMost = 31;  // intervals whose median is the load's

// Returns the median of the intervals before a sample [s]; 0: too few are known.
double interval_before(const std::set<double>& times, std::set<double>::const_iterator sample) {
  std::vector<double> intervals;
  for (; sample != times.begin() && intervals.size() < kMost; --sample) intervals.push_back(*sample - *std::prev(sample));
  if (intervals.size() < kFewest) return 0.0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

}  // namespace

std::string LoadSilence::find(double time) {
  for (auto& [topic, times] : times_) {
    const auto next = times.upper_bound(time);
    if (next == times.begin()) continue;
    const auto last = std::prev(next);
    const double since = time - *last, interval = interval_before(times, last);
    auto oldest = last;
    for (std::size_t k = 0; k < kMost && oldest != times.begin(); ++k) --oldest;
    times.erase(times.begin(), oldest);
    if (interval == 0.0 || since <= kPauses * interval) continue;
    std::ostringstream text;
    text << "no load on " << topic << " for " << std::setprecision(3) << since << " s, where one comes every " << interval
         << " s";
    return text.str();
  }
  return "";
}

}  // namespace tissue_stiffness
