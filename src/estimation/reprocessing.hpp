#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "estimation/background_reprocessing.hpp"
#include "estimation/change_history.hpp"
#include "estimation/change_watch.hpp"
#include "estimation/iterated_filter.hpp"
#include "estimation/scheme.hpp"

namespace tissue_stiffness {

/// Reprocessing keeps the frames since the filter's start, and goes over them again when that is due. Then it moves the
/// sigma points, searches for a change of the parameters, or leaves the older half of the frames behind.
class Reprocessing {
 public:
  explicit Reprocessing(const Model& model);

  /// Keeps a frame that the filter has absorbed.
  void keep(const Frame& frame);
  /// Watches the misfit for a change of the parameters: a frame's mean square error over sigma, and the filter after it.
  void watch(double square, const PosteriorLinearizationFilter& filter) { watch_.add(square, filter); }

  /// A round over the frames had this result.
  enum class Result {
    unchanged,  ///< the filter goes on as it is
    moved,      ///< another filter of the same parameters has taken its place
    changed     ///< the same, after a change of the parameters
  };
  /// Reprocesses where that is due: at once, or beside the frames where they are hurried. A filter whose runs changed takes
  /// the place of `filter`.
  Result run(std::shared_ptr<IteratedFilter>& filter, const Pace& pace);
  /// Does the same with the result of a round that has ended beside the frames; `unchanged` if none has.
  Result take_finished(std::shared_ptr<IteratedFilter>& filter);
  bool under_way() const { return background_ != nullptr; }
  bool finished() const { return background_ != nullptr && background_->finished(); }
  /// Gives up what is under way.
  void stop() { background_ = nullptr; }
  void forget();

  /// Returns the frames since the filter's start.
  const std::vector<Frame>& frames() const { return frames_; }
  const ChangeHistory& history() const { return history_; }
  /// A filter that is not complete has absorbed more frames than were kept: from then on it only adds information.
  bool complete() const { return complete_; }
  bool change_suspected() const { return watch_.suspicious() && !watch_.searched(); }

 private:
  Result reprocess(std::shared_ptr<IteratedFilter>& filter, const IteratedFilter& from, const std::vector<Frame>& frames,
                   BackgroundReprocessing::Task task, const Pace& pace);
  Result adopt(std::shared_ptr<IteratedFilter>& filter, BackgroundReprocessing::Outcome outcome);
  void stop_keeping();

  std::size_t window_;  ///< number of frames that are kept
  std::vector<Frame> frames_;
  ChangeHistory history_;
  ChangeWatch watch_;
  bool complete_ = true;
  std::size_t frames_at_last_ = 0;  ///< number of frames at the last round
  std::unique_ptr<BackgroundReprocessing> background_;
};

}  // namespace tissue_stiffness
