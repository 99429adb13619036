#include "tissue_stiffness/estimation/aside.hpp"

#include <sys/resource.h>
#include <tbb/task_arena.h>

#include <utility>

namespace tissue_stiffness {
namespace {

constexpr int kNiceness = 10;

}  // namespace

void beside(const std::function<void()>& work) {
  setpriority(PRIO_PROCESS, 0, kNiceness);  // Linux: of this thread alone
  tbb::task_arena one_core(1);
  one_core.execute(work);
}

std::future<void> aside(std::function<void()> work) {
  return std::async(std::launch::async, [work = std::move(work)] { beside(work); });
}

}  // namespace tissue_stiffness
