#pragma once

#include <string>

#include "tools/command_line.hpp"
#include "tools/run_manifest.hpp"
#include "tools/run_tool.hpp"

namespace tissue_stiffness {

/// Arguments of `estimate` for the recordings of a manifest.
struct ManifestOption {
  std::string file, shard = "1/1", merged;
  ManifestTask task;

  void add_to(CommandLine& line);
};

/// Estimates from the rows of the manifest, or merges their results.
ExitCode estimate_manifest(ManifestOption& option, bool quiet, const StopRequest& stop);

}  // namespace tissue_stiffness
