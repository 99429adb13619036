#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "estimation/iterated_filter.hpp"
#include "fit/free_run.hpp"

namespace tissue_stiffness {

/// The history holds what was before the parameters changed. It keeps the frames that the present filter does not hold, and
/// the filter from which the last change can be searched for again.
class ChangeHistory {
 public:
  bool empty() const { return changes_.empty(); }
  std::size_t frame_count() const { return frames_.size(); }

  /// Records that `next` goes on from `now`, which has gone through `frames`. The change comes after `first` of the frames
  /// that the question was asked about; those leave `frames`. A question about a known change moves that change.
  void record_change(const IteratedFilter& now, const IteratedFilter& next, std::size_t first,
                     const ChangeQuestion& question, std::vector<Frame>& frames);

  /// Asks for the last change anew, once the filter after it holds `count` frames and knows more about it.
  std::optional<ChangeQuestion> closer(std::size_t count);
  /// These are the filter before the last change, not started, and the frames since its start.
  const IteratedFilter& filter() const { return *filter_run_; }
  std::vector<Frame> frames_since_its_start(const std::vector<Frame>& frames) const;

  /// The free run needs every frame, the parameters at the start, and each change. `theta` holds the parameters after the
  /// last one.
  std::vector<Frame> all_frames(const std::vector<Frame>& frames) const;
  const Eigen::VectorXd& theta() const { return theta_; }
  std::vector<ParameterChange> changes(const Eigen::VectorXd& theta) const;

 private:
  std::vector<Frame> frames_from(std::size_t first, const std::vector<Frame>& frames) const;

  std::vector<Frame> frames_;
  Eigen::VectorXd theta_;                             ///< parameters at the start
  std::vector<ParameterChange> changes_;              ///< without the last one's theta, which the present filter knows
  std::shared_ptr<const IteratedFilter> filter_run_;  ///< filter before the last change, as it began
  std::size_t begin_ = 0;                             ///< first frame of filter_run_
  ChangeQuestion question_;                           ///< question that found the last change
  std::size_t next_ = 0;                              ///< number of frames after it at which it is asked again
};

}  // namespace tissue_stiffness
