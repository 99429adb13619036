#pragma once

#include <functional>
#include <vector>

#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// A recording in memory: what a diagnosis runs again and again.
struct Recording {
  std::vector<Frame> frames;  ///< in order of time, none before the body's rest
  std::vector<LoadSample> loads;
  double first_stamp = 0.0;  ///< [s]
  /// Called before every frame of every run; what it throws ends the study.
  std::function<void()> checkpoint = [] {};

  /// Blocks of frames are set aside, so that neither a fit nor its success is judged by what it saw: every third ninth of
  /// the recording. Longer blocks were all in one part of a body's rhythm.
  std::vector<Frame> training() const;
  bool held_out(std::size_t frame) const { return (9 * frame / frames.size()) % 3 == 2; }
};

}  // namespace tissue_stiffness
