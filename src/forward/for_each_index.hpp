#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <array>
#include <exception>
#include <functional>
#include <vector>

namespace tissue_stiffness {

/// Runs act(i) for i < count in parallel. When all have ended, the error of the lowest i is thrown, whatever the order of
/// the threads.
///
/// An error that leaves the body of a TBB loop cancels the loops inside its siblings, which then return without having done
/// their work. Here an error stays in its own call, and the other calls complete all inner loops.
template <typename Act, typename Partitioner = tbb::auto_partitioner>
void for_each_index(std::size_t count, const Act& act, const Partitioner& partitioner = {}) {
  std::vector<std::exception_ptr> errors(count);
  tbb::parallel_for(
      std::size_t{0}, count,
      [&](std::size_t i) {
        try {
          act(i);
        } catch (...) {
          errors[i] = std::current_exception();
        }
      },
      partitioner);
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

/// Runs a few different functions in parallel and treats their errors as for_each_index does.
template <typename... Acts>
void run_side_by_side(const Acts&... acts) {
  const std::array<std::function<void()>, sizeof...(acts)> all{std::cref(acts)...};
  for_each_index(
      all.size(), [&](std::size_t i) { all[i](); }, tbb::simple_partitioner());
}

}  // namespace tissue_stiffness
