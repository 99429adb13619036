#include "tissue_stiffness/estimation/revisit.hpp"

#include <chrono>
#include <utility>

#include "tissue_stiffness/estimation/aside.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

Revisit::Revisit(const Track& track, std::vector<Frame> frames, Task task)
    : frames_(std::move(frames)), outcome_{track.twin(), std::move(task)} {
  work_ = aside([this] { run(); });
}

Revisit::~Revisit() {
  given_up_ = true;
  if (work_.valid()) work_.wait();
}

void Revisit::add(const Frame& frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  later_.push_back(frame);
}

std::vector<Frame> Revisit::arrived() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(later_, {});
}

Revisit::Outcome Revisit::look(std::unique_ptr<Track> twin, const std::vector<Frame>& frames, Task task,
                               const Track::Checkpoint& checkpoint) {
  Outcome out{std::move(twin), std::move(task)};
  std::unique_ptr<Track> next;
  if (out.task.roll > 0) {
    out.first = out.task.roll;
    next = out.track->rolled(frames, out.first, checkpoint);
  } else if (out.task.change) {
    next = out.track->changed(frames, *out.task.change, checkpoint, out.first);
  } else {
    out.moved = out.track->look(frames, checkpoint);
    return out;
  }
  out.moved = next != nullptr;
  if (next) out.track = std::move(next);
  return out;
}

void Revisit::run() {
  const auto checkpoint = [this] {
    if (given_up_) throw NumericalError("given up");
  };
  outcome_ = look(std::move(outcome_.track), frames_, std::move(outcome_.task), checkpoint);
  if (!outcome_.moved) return;
  for (std::vector<Frame> more = arrived(); !more.empty(); more = arrived()) {
    for (const Frame& frame : more) {
      checkpoint();
      outcome_.track->absorb(frame);
    }
  }
}

bool Revisit::finished() const {
  return work_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

Revisit::Outcome Revisit::take() {
  work_.get();
  if (outcome_.moved) {
    for (const Frame& frame : arrived()) outcome_.track->absorb(frame);
  }
  return std::move(outcome_);
}

}  // namespace tissue_stiffness
