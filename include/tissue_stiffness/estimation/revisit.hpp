#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <vector>

#include "tissue_stiffness/estimation/track.hpp"

namespace tissue_stiffness {

/// A look at the recording so far, beside the frames that keep coming.
class Revisit {
 public:
  /// Begins at once, with copies.
  Revisit(const Track& track, std::vector<Frame> frames);
  /// Gives up.
  ~Revisit();
  Revisit(const Revisit&) = delete;
  Revisit& operator=(const Revisit&) = delete;

  /// A frame that came meanwhile: a track that moved goes through it, too.
  void add(const Frame& frame);
  bool finished() const;
  struct Outcome {
    std::unique_ptr<Track> track;
    bool moved = false;  ///< false: only its notes are new
  };
  /// Waits for the end; a track that moved is at the last frame added. Throws NumericalError when it cannot follow.
  Outcome take();

 private:
  void run();
  std::vector<Frame> arrived();

  std::vector<Frame> frames_;
  Outcome outcome_;
  std::mutex mutex_;
  std::vector<Frame> later_;  ///< arrived, and not yet gone through
  std::atomic<bool> given_up_{false};
  std::future<void> work_;  ///< last: uses the members above
};

}  // namespace tissue_stiffness
