#include "estimation/change_history.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kAskedAgain = 8;   // frames after a change when it is asked again
constexpr std::size_t kAskedLast = 100;  // frames beyond which its instant is known

}  // namespace

void ChangeHistory::record_change(const IteratedFilter& now, const IteratedFilter& next, std::size_t first,
                                  const ChangeQuestion& question, std::vector<Frame>& frames) {
  if (question.near) {
    frames = frames_since_its_start(frames);
    frames_.resize(begin_);
    changes_.pop_back();
  } else {
    begin_ = frames_.size();
    filter_run_ = now.clone_unstarted();
    question_ = question;
    next_ = kAskedAgain;
    const Eigen::VectorXd before = now.theta(question.w);
    (changes_.empty() ? theta_ : changes_.back().theta) = before;
  }
  changes_.push_back({next.start().time, {}});
  const auto end = frames.begin() + static_cast<std::ptrdiff_t>(first);
  frames_.insert(frames_.end(), frames.begin(), end);
  frames.erase(frames.begin(), end);
}

std::optional<ChangeQuestion> ChangeHistory::closer(std::size_t count) {
  if (empty() || count < next_ || next_ > kAskedLast) return std::nullopt;
  next_ = 2 * count;
  question_.near = changes_.back().time;
  return question_;
}

std::vector<Frame> ChangeHistory::frames_from(std::size_t first, const std::vector<Frame>& frames) const {
  std::vector<Frame> out(frames_.begin() + static_cast<std::ptrdiff_t>(first), frames_.end());
  out.insert(out.end(), frames.begin(), frames.end());
  return out;
}

std::vector<Frame> ChangeHistory::frames_since_its_start(const std::vector<Frame>& frames) const {
  return frames_from(begin_, frames);
}

std::vector<Frame> ChangeHistory::all_frames(const std::vector<Frame>& frames) const {
  return frames_from(0, frames);
}

std::vector<ParameterChange> ChangeHistory::changes(const Eigen::VectorXd& theta) const {
  std::vector<ParameterChange> out = changes_;
  out.back().theta = theta;
  return out;
}

}  // namespace tissue_stiffness
