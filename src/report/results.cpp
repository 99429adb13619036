#include "report/results.hpp"

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {

int Results::used() const {
  int of_several = 0;
  for (const RecordingRecord& recording : recordings) of_several += recording.predicted ? 0 : recording.frames;
  return of_several +
         static_cast<int>(std::count_if(frames.begin(), frames.end(), [](const FrameRecord& f) { return f.used; }));
}

int Results::skipped() const {
  return static_cast<int>(std::count_if(frames.begin(), frames.end(), [](const FrameRecord& f) { return !f.used; }));
}

double Results::frame_seconds_quantile(double p) const {
  if (frame_seconds.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = frame_seconds;
  std::sort(sorted.begin(), sorted.end());
  const double rank = std::ceil(p * static_cast<double>(sorted.size())) - 1.0;
  return sorted[static_cast<std::size_t>(std::max(0.0, rank))];
}

}  // namespace tissue_stiffness
