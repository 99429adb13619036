// Stands before TBB's header of this name in a build with ThreadSanitizer: see happens_before.h.
#pragma once

#define parallel_for parallel_for_unseen
#include_next <tbb/parallel_for.h>
#undef parallel_for

#include "happens_before.h"

namespace tbb {

template <typename Range, typename Body, typename... Partitioner>
auto parallel_for(const Range& range, const Body& body, const Partitioner&... partitioner) -> decltype(body(range)) {
  happens_before::Loop loop;
  parallel_for_unseen(range, happens_before::Ordered<Body>{&loop, &body}, partitioner...);
  loop.finish();
}

template <typename Index, typename Body, typename... Partitioner>
auto parallel_for(Index first, Index last, const Body& body, const Partitioner&... partitioner) -> decltype(body(first)) {
  happens_before::Loop loop;
  parallel_for_unseen(first, last, happens_before::Ordered<Body>{&loop, &body}, partitioner...);
  loop.finish();
}

}  // namespace tbb
