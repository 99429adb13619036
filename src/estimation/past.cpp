#include "tissue_stiffness/estimation/past.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kAskedAgain = 8;   // frames after a change
constexpr std::size_t kAskedLast = 100;  // and beyond which its instant is known

}  // namespace

void Past::turn(const Track& now, const Track& next, std::size_t first, const ChangeQuestion& question,
                std::vector<Frame>& frames) {
  if (question.near) {
    frames = frames_since_its_start(frames);
    frames_.resize(begin_);
    turns_.pop_back();
  } else {
    begin_ = frames_.size();
    track_ = now.twin();
    question_ = question;
    next_ = kAskedAgain;
    const Eigen::VectorXd before = now.theta(question.w);
    (turns_.empty() ? theta_ : turns_.back().theta) = before;
  }
  turns_.push_back({next.start().time, {}});
  const auto end = frames.begin() + static_cast<std::ptrdiff_t>(first);
  frames_.insert(frames_.end(), frames.begin(), end);
  frames.erase(frames.begin(), end);
}

std::optional<ChangeQuestion> Past::closer(std::size_t count) {
  if (empty() || count < next_ || next_ > kAskedLast) return std::nullopt;
  next_ = 2 * count;
  question_.near = turns_.back().time;
  return question_;
}

std::vector<Frame> Past::frames_from(std::size_t first, const std::vector<Frame>& frames) const {
  std::vector<Frame> out(frames_.begin() + static_cast<std::ptrdiff_t>(first), frames_.end());
  out.insert(out.end(), frames.begin(), frames.end());
  return out;
}

std::vector<Frame> Past::frames_since_its_start(const std::vector<Frame>& frames) const {
  return frames_from(begin_, frames);
}

std::vector<Frame> Past::all_frames(const std::vector<Frame>& frames) const {
  return frames_from(0, frames);
}

std::vector<Turn> Past::turns(const Eigen::VectorXd& theta) const {
  std::vector<Turn> out = turns_;
  out.back().theta = theta;
  return out;
}

}  // namespace tissue_stiffness
