#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <exception>
#include <vector>

namespace tissue_stiffness {

/// Runs act(i) for i < count in parallel; the error of the lowest i is thrown, whatever the threads did.
template <typename Act>
void for_each_index(std::size_t count, const Act& act) {
  std::vector<std::exception_ptr> errors(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    try {
      act(i);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace tissue_stiffness
