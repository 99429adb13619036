#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "tissue_stiffness/estimation/track.hpp"

namespace tissue_stiffness {

/// A look at the recording so far, beside the frames that keep coming.
class Revisit {
 public:
  /// What else than a look: for a change of the parameters, or to leave the first `roll` frames behind.
  struct Task {
    std::optional<ChangeQuestion> change;
    std::size_t roll = 0;
  };
  /// Begins at once, with copies.
  Revisit(const Track& track, std::vector<Frame> frames, Task task);
  /// Gives up.
  ~Revisit();
  Revisit(const Revisit&) = delete;
  Revisit& operator=(const Revisit&) = delete;

  /// A frame that came meanwhile: a track that moved goes through it, too.
  void add(const Frame& frame);
  bool finished() const;
  /// What came of a look.
  struct Outcome {
    std::unique_ptr<Track> track;
    Task task;
    bool moved = false;  ///< false: only its notes are new
    std::size_t first =
        0;  ///< frame that the track begins with; 0 unless the parameters changed or frames were left behind
  };
  /// Waits for the end; a track that moved is at the last frame added. Throws NumericalError when it cannot follow.
  Outcome take();

  /// The look itself, at once; with a twin of the track that goes on.
  static Outcome look(std::unique_ptr<Track> twin, const std::vector<Frame>& frames, Task task,
                      const Track::Checkpoint& checkpoint);

 private:
  void run();
  std::vector<Frame> arrived();

  std::vector<Frame> frames_;
  Outcome outcome_;  ///< before the end: what the look begins with
  std::mutex mutex_;
  std::vector<Frame> later_;  ///< arrived, and not yet gone through
  std::atomic<bool> given_up_{false};
  std::future<void> work_;  ///< last: uses the members above
};

}  // namespace tissue_stiffness
