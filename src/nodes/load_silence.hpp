#pragma once

#include <map>
#include <set>
#include <string>

#include "tissue_stiffness/types/load_sample.hpp"

namespace tissue_stiffness {

/// Knows where the loads are known. A load that falls silent is held by the model, and the motion meanwhile says nothing of
/// the body. So frames are left out whose load is older than five of its intervals. Used by one thread.
class LoadSilence {
 public:
  void add(const LoadSample& sample) { times_[sample.topic].insert(sample.time); }

  /// Returns which load is silent at the time of a frame, as a sentence; empty: none. Frames come in the order of time.
  std::string find(double time);

  /// Forgets all samples.
  void clear() { times_.clear(); }

 private:
  std::map<std::string, std::set<double>> times_;  ///< of the samples, by topic [s]
};

}  // namespace tissue_stiffness
