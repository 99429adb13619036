#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "tissue_stiffness/estimation/free_run.hpp"
#include "tissue_stiffness/estimation/track.hpp"

namespace tissue_stiffness {

/// What was before the parameters changed: frames that today's track does not hold, and where it may be looked for again
/// when the change itself was.
class Past {
 public:
  bool empty() const { return turns_.empty(); }
  std::size_t frame_count() const { return frames_.size(); }

  /// `next` goes on from `now`, which has gone through `frames`, at a change after `first` of the frames that the question
  /// was asked about; those leave `frames`. A question about a known change moves that one.
  void turn(const Track& now, const Track& next, std::size_t first, const ChangeQuestion& question,
            std::vector<Frame>& frames);

  /// Asks for the last change anew, once the track after it holds `count` frames and knows more about it.
  std::optional<ChangeQuestion> closer(std::size_t count);
  /// The track before the last change, and the frames since its start.
  const Track& track() const { return *track_; }
  std::vector<Frame> frames_since_its_start(const std::vector<Frame>& frames) const;

  /// For the free run: every frame, the parameters at the start, and each change; `theta`: those after the last.
  std::vector<Frame> all_frames(const std::vector<Frame>& frames) const;
  const Eigen::VectorXd& theta() const { return theta_; }
  std::vector<Turn> turns(const Eigen::VectorXd& theta) const;

 private:
  std::vector<Frame> frames_from(std::size_t first, const std::vector<Frame>& frames) const;

  std::vector<Frame> frames_;
  Eigen::VectorXd theta_;               ///< at the start
  std::vector<Turn> turns_;             ///< the last one's theta is not kept: today's track knows it
  std::shared_ptr<const Track> track_;  ///< before the last change, as it began
  std::size_t begin_ = 0;               ///< its first frame
  ChangeQuestion question_;             ///< that found the last change
  std::size_t next_ = 0;                ///< frames after it when it is asked again
};

}  // namespace tissue_stiffness
