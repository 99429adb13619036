#pragma once

#include <functional>
#include <future>

namespace tissue_stiffness {

/// Does `work` on this thread, which keeps a low priority from then on, and on one core.
void beside(const std::function<void()>& work);
/// Runs `work` beside the frames: on a thread of its own, of low priority, on one core. What it throws comes out of the
/// future, whose destructor waits.
std::future<void> aside(std::function<void()> work);

}  // namespace tissue_stiffness
