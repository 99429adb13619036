#pragma once

#include <functional>
#include <future>

namespace tissue_stiffness {

/// Does `work` on this thread, on one core; the thread keeps a low priority from then on.
void run_at_low_priority(const std::function<void()>& work);
/// Runs `work` in the background: on a thread of its own, of low priority, on one core. What it throws comes out of the
/// future, whose destructor waits.
std::future<void> at_low_priority(std::function<void()> work);

}  // namespace tissue_stiffness
