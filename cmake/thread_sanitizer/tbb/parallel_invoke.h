// Stands before TBB's header of this name in a build with ThreadSanitizer: see happens_before.h.
#pragma once

#define parallel_invoke parallel_invoke_unseen
#include_next <tbb/parallel_invoke.h>
#undef parallel_invoke

#include "happens_before.h"

namespace tbb {

template <typename... Acts>
void parallel_invoke(const Acts&... acts) {
  happens_before::Loop loop;
  parallel_invoke_unseen(happens_before::Ordered<Acts>{&loop, &acts}...);
  loop.finish();
}

}  // namespace tbb
