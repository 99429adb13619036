#pragma once

#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tissue_stiffness {

/// For programs that end soon: freed memory is kept for what asks next, by any thread. Asking the system for the large
/// matrices anew takes a tenth of a diagnosis. To be called first of all; does nothing without GNU's C library.
inline void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int never = -1, ahead = 64 * 1024 * 1024;  // [byte]
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, never);
  mallopt(M_TOP_PAD, ahead);
#endif
}

/// For programs that run for long, after work that took much: gives freed memory back to the system.
inline void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace tissue_stiffness
