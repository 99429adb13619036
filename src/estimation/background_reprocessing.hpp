#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "estimation/iterated_filter.hpp"

namespace tissue_stiffness {

/// Reprocessing goes over the recording so far in the background, while more frames keep coming.
class BackgroundReprocessing {
 public:
  /// Without a task, reprocessing relinearizes. With one it searches for a change of the parameters, or leaves the first
  /// `roll` frames behind.
  struct Task {
    std::optional<ChangeQuestion> change;
    std::size_t roll = 0;
  };
  /// Starts at once, on copies.
  BackgroundReprocessing(const IteratedFilter& filter, std::vector<Frame> frames, Task task);
  /// Ends the work early.
  ~BackgroundReprocessing();
  BackgroundReprocessing(const BackgroundReprocessing&) = delete;
  BackgroundReprocessing& operator=(const BackgroundReprocessing&) = delete;

  /// Adds a frame that came meanwhile: a filter whose runs changed goes through it too.
  void add(const Frame& frame);
  bool finished() const;
  /// This is the result of a reprocessing.
  struct Outcome {
    std::unique_ptr<IteratedFilter> filter;
    Task task;
    bool moved = false;     ///< true: the runs changed; false: only the notes are new
    std::size_t first = 0;  ///< frame that the filter begins with; 0 unless parameters changed or frames were left behind
  };
  /// Waits for the end; a filter whose runs changed is then at the last frame added. Throws NumericalError when it cannot
  /// follow.
  Outcome take();

  /// Reprocesses at once, with `unstarted`, the clone_unstarted() of the filter that goes on.
  static Outcome reprocess(std::unique_ptr<IteratedFilter> unstarted, const std::vector<Frame>& frames, Task task,
                           const IteratedFilter::Checkpoint& checkpoint);

 private:
  void run();
  std::vector<Frame> arrived();

  std::vector<Frame> frames_;
  Outcome outcome_;  ///< before the end: what the work begins with
  std::mutex mutex_;
  std::vector<Frame> later_;  ///< arrived, and not yet processed
  std::atomic<bool> given_up_{false};
  std::future<void> work_;  ///< declared last, because it uses the members above
};

}  // namespace tissue_stiffness
