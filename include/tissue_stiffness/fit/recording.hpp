#pragma once

#include <functional>
#include <vector>

#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// A recording is kept in memory, because a diagnosis runs it again and again.
struct Recording {
  std::vector<Frame> frames;  ///< in order of time, none before the body's rest
  std::vector<LoadSample> loads;
  double first_stamp = 0.0;  ///< [s]
  /// It is called before every frame of every run; what it throws ends the fit.
  std::function<void()> checkpoint = [] {};

  /// Returns the frames to fit. Every third ninth of the recording is held out, so that an error can be reported on frames
  /// that no fit saw. Longer blocks would each fall into one part of a body's rhythm.
  std::vector<Frame> training() const;
  bool held_out(std::size_t frame) const { return (9 * frame / frames.size()) % 3 == 2; }
};

}  // namespace tissue_stiffness
