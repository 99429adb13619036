#include "estimation/background_reprocessing.hpp"

#include <chrono>
#include <utility>

#include "estimation/low_priority.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

BackgroundReprocessing::BackgroundReprocessing(const IteratedFilter& filter, std::vector<Frame> frames, Task task)
    : frames_(std::move(frames)), outcome_{filter.clone_unstarted(), std::move(task)} {
  work_ = at_low_priority([this] { run(); });
}

BackgroundReprocessing::~BackgroundReprocessing() {
  given_up_ = true;
  if (work_.valid()) work_.wait();
}

void BackgroundReprocessing::add(const Frame& frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  later_.push_back(frame);
}

std::vector<Frame> BackgroundReprocessing::arrived() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(later_, {});
}

BackgroundReprocessing::Outcome BackgroundReprocessing::reprocess(std::unique_ptr<IteratedFilter> unstarted,
                                                                  const std::vector<Frame>& frames, Task task,
                                                                  const IteratedFilter::Checkpoint& checkpoint) {
  Outcome out{std::move(unstarted), std::move(task)};
  std::unique_ptr<IteratedFilter> next;
  if (out.task.roll > 0) {
    out.first = out.task.roll;
    next = out.filter->rolled(frames, out.first, checkpoint);
  } else if (out.task.change) {
    next = out.filter->changed(frames, *out.task.change, checkpoint, out.first);
  } else {
    out.moved = out.filter->relinearize(frames, checkpoint);
    return out;
  }
  out.moved = next != nullptr;
  if (next) out.filter = std::move(next);
  return out;
}

void BackgroundReprocessing::run() {
  const auto checkpoint = [this] {
    if (given_up_) throw NumericalError("given up");
  };
  outcome_ = reprocess(std::move(outcome_.filter), frames_, std::move(outcome_.task), checkpoint);
  if (!outcome_.moved) return;
  for (std::vector<Frame> more = arrived(); !more.empty(); more = arrived()) {
    for (const Frame& frame : more) {
      checkpoint();
      outcome_.filter->absorb(frame);
    }
  }
}

bool BackgroundReprocessing::finished() const {
  return work_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

BackgroundReprocessing::Outcome BackgroundReprocessing::take() {
  work_.get();
  if (outcome_.moved) {
    for (const Frame& frame : arrived()) outcome_.filter->absorb(frame);
  }
  return std::move(outcome_);
}

}  // namespace tissue_stiffness
