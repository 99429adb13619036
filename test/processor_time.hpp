#pragma once

#include <ctime>

namespace tissue_stiffness {

/// The processor time of the calling thread [s]: unlike the time of a clock, no other process adds to it.
inline double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace tissue_stiffness
