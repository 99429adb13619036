#pragma once

#include <cstddef>

namespace tissue_stiffness {

/// What this process, every library of it, has asked the heap for since it started.
struct Heap {
  std::size_t requests, bytes;
};
Heap heap();

}  // namespace tissue_stiffness
