#include "estimation/low_priority.hpp"

#include <sys/resource.h>
#include <tbb/task_arena.h>

#include <utility>

namespace tissue_stiffness {
namespace {

constexpr int kNiceness = 10;

}  // namespace

void run_at_low_priority(const std::function<void()>& work) {
  setpriority(PRIO_PROCESS, 0, kNiceness);  // on Linux this concerns this thread alone
  tbb::task_arena one_core(1);
  one_core.execute(work);
}

std::future<void> at_low_priority(std::function<void()> work) {
  return std::async(std::launch::async, [work = std::move(work)] { run_at_low_priority(work); });
}

}  // namespace tissue_stiffness
