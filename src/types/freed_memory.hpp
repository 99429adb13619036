#pragma once

#include <algorithm>
#include <cstdlib>
#include <thread>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tissue_stiffness {

/// Keeps freed memory in the process for later allocations. It is for programs that end soon, where requesting the large
/// matrices from the system again takes a tenth of a diagnosis. Each thread has a heap: with one heap for all, threads that
/// wait for it take a fifth of a long diagnosis. It must be called before anything else, and does nothing without GNU's C
/// library.
inline void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int never = -1, ahead = 64 * 1024 * 1024;  // [byte]
  mallopt(M_ARENA_MAX, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, never);
  mallopt(M_TOP_PAD, ahead);
#endif
}

/// Has large blocks returned to the system when they are freed, and keeps small ones together. It is for programs that run
/// for long: by default each thread has a heap of its own, which keeps most of what a background job has freed. It must be
/// called before any thread is started.
inline void return_large_blocks() {
#ifdef __GLIBC__
  constexpr int heaps = 2, large = 1024 * 1024, top = 4 * 1024 * 1024;  // [byte]
  mallopt(M_ARENA_MAX, heaps);
  mallopt(M_MMAP_THRESHOLD, large);
  mallopt(M_TRIM_THRESHOLD, top);
#endif
}

/// Returns freed memory to the system. It is for programs that run for long, after work that took much memory.
inline void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace tissue_stiffness
