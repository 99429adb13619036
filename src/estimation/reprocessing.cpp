#include "estimation/reprocessing.hpp"

#include <utility>

namespace tissue_stiffness {
namespace {

constexpr double kReplayGrowth = 1.5;  // growth of a replay between rounds: nobody reads its estimates on the way

}  // namespace

Reprocessing::Reprocessing(const Model& model)
    : window_(static_cast<std::size_t>(model.settings().window)),
      watch_((model.parameters().drift().array() > 0.0).any()) {}

void Reprocessing::keep(const Frame& frame) {
  if (complete_) frames_.push_back(frame);
  if (background_) background_->add(frame);
  if (complete_ && frames_.size() + history_.frame_count() > window_) history_ = {};
}

Reprocessing::Result Reprocessing::run(std::shared_ptr<IteratedFilter>& filter, const Pace& pace) {
  if (background_ || !complete_) return Result::unchanged;
  if (frames_.size() > window_) return reprocess(filter, *filter, frames_, {std::nullopt, frames_.size() / 2}, pace);
  if (pace.near != nullptr && pace.more_follow) return Result::unchanged;
  if (std::optional<ChangeQuestion> again = history_.closer(frames_.size())) {
    return reprocess(filter, history_.filter(), history_.frames_since_its_start(frames_), {std::move(again)}, pace);
  }
  std::optional<ChangeQuestion> question = watch_.due();
  const bool calm = !watch_.suspicious() || watch_.searched();
  const bool too_soon = pace.replaying && pace.more_follow &&
                        static_cast<double>(frames_.size()) < kReplayGrowth * static_cast<double>(frames_at_last_);
  if (!question && !(calm && !too_soon && filter->wants_relinearization(frames_.size()))) return Result::unchanged;
  frames_at_last_ = frames_.size();
  return reprocess(filter, *filter, frames_, {std::move(question)}, pace);
}

Reprocessing::Result Reprocessing::reprocess(std::shared_ptr<IteratedFilter>& filter, const IteratedFilter& from,
                                             const std::vector<Frame>& frames, BackgroundReprocessing::Task task,
                                             const Pace& pace) {
  if (!pace.hurried())
    return adopt(filter, BackgroundReprocessing::reprocess(from.clone_unstarted(), frames, std::move(task), [] {}));
  background_ = std::make_unique<BackgroundReprocessing>(from, frames, std::move(task));
  return Result::unchanged;
}

Reprocessing::Result Reprocessing::take_finished(std::shared_ptr<IteratedFilter>& filter) {
  return finished() ? adopt(filter, std::exchange(background_, nullptr)->take()) : Result::unchanged;
}

Reprocessing::Result Reprocessing::adopt(std::shared_ptr<IteratedFilter>& filter, BackgroundReprocessing::Outcome outcome) {
  const BackgroundReprocessing::Task& task = outcome.task;
  if (!outcome.moved) {
    if (task.roll > 0) stop_keeping();
    if (task.roll == 0 && !task.change) filter->take_notes(*outcome.filter);
    return Result::unchanged;
  }
  if (task.roll > 0) {
    frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(outcome.first));
    history_ = {};
  } else if (task.change) {
    history_.record_change(*filter, *outcome.filter, outcome.first, *task.change, frames_);
    if (!task.change->near) watch_.go_on();
  }
  filter = std::move(outcome.filter);
  return task.roll == 0 && task.change ? Result::changed : Result::moved;
}

void Reprocessing::stop_keeping() {
  complete_ = false;
  frames_.clear();
  history_ = {};
}

void Reprocessing::forget() {
  stop();
  frames_.clear();
  history_ = {};
  watch_.restart();
  complete_ = true;
  frames_at_last_ = 0;
}

}  // namespace tissue_stiffness
