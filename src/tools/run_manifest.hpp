#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tools/manifest.hpp"
#include "types/stop_request.hpp"

namespace tissue_stiffness {

/// What to do with the rows of a manifest.
struct ManifestTask {
  std::string output;                  ///< folder that gets a folder for each row
  std::size_t shard = 1, shards = 1;   ///< every `shards`-th row, beginning with this one, counted from 1
  std::size_t processes = 1;           ///< rows that are estimated at once
  bool resume = false;                 ///< keep the rows that are answered already
  std::vector<std::string> arguments;  ///< of `estimate`, for each row
};

/// Number of rows of the shard, by what became of them.
struct ManifestOutcome {
  std::size_t answered = 0, kept = 0, failed = 0, interrupted = 0;
};

/// Reads "2/3": the shard and their number. Throws InputError unless 1 <= shard <= number.
void read_shard(const std::string& text, ManifestTask& task);

/// Runs `estimate` on each row of a shard, in a process of its own, so that a bad recording ends only its row. A row's
/// results are written to a folder beside and renamed, with `status.json` last in it. `tell` hears how many rows are over
/// and how many there are.
///
/// When it is asked to stop, it ends the rows under way, which stay undone. Rows whose process crashed have a status with
/// what is known; they are tried again by `resume`.
ManifestOutcome run_manifest(const Manifest& manifest, const ManifestTask& task,
                             const std::function<void(std::size_t, std::size_t)>& tell, const StopRequest& stop);

}  // namespace tissue_stiffness
