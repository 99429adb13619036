#include "tissue_stiffness/estimation/revisit.hpp"

#include <chrono>
#include <utility>

#include "tissue_stiffness/estimation/aside.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

Revisit::Revisit(const Track& track, std::vector<Frame> frames, std::optional<ChangeQuestion> change)
    : frames_(std::move(frames)), outcome_{track.twin(), false, 0, std::move(change)} {
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

Revisit::Outcome Revisit::look(std::unique_ptr<Track> twin, const std::vector<Frame>& frames,
                               std::optional<ChangeQuestion> change, const Track::Checkpoint& checkpoint) {
  Outcome out{std::move(twin), false, 0, std::move(change)};
  if (!out.change) {
    out.moved = out.track->look(frames, checkpoint);
  } else if (auto changed = out.track->changed(frames, *out.change, checkpoint, out.first)) {
    out.track = std::move(changed);
    out.moved = true;
  }
  return out;
}

void Revisit::run() {
  const auto checkpoint = [this] {
    if (given_up_) throw NumericalError("given up");
  };
  outcome_ = look(std::move(outcome_.track), frames_, std::move(outcome_.change), checkpoint);
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
