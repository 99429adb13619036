// ThreadSanitizer does not see that TBB, which is compiled without it, hands work from thread to thread in order. These
// functions tell it: what comes before a loop happens before its bodies, and these before what comes after. So a race
// between two bodies is still found. What TBB itself keeps in its tasks is suppressed by name (suppressions.txt).
#pragma once

extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);

namespace tbb {
namespace happens_before {

struct Loop {
  char begin = 0, end = 0;

  Loop() { __tsan_release(&begin); }
  void finish() { __tsan_acquire(&end); }
};

/// A body with both orders. The argument is copied, because TBB keeps it in a task that other threads have written.
template <typename Body>
struct Ordered {
  Loop* loop;
  const Body* body;

  template <typename Part>
  void operator()(const Part& part) const {
    __tsan_acquire(&loop->begin);
    const Part own(part);
    (*body)(own);
    __tsan_release(&loop->end);
  }
  void operator()() const {
    __tsan_acquire(&loop->begin);
    (*body)();
    __tsan_release(&loop->end);
  }
};

}  // namespace happens_before
}  // namespace tbb
