#include "tools/manifest_option.hpp"

#include <iostream>

#include "report/write_results.hpp"
#include "tools/merge_manifest.hpp"
#include "tools/progress.hpp"

namespace tissue_stiffness {

void ManifestOption::add_to(CommandLine& line) {
  const CommandArgument& manifest =
      line.add_option("--manifest", file, "CSV file with the columns model and recording: estimate from each of its rows");
  line.add_option("--shard", shard, "I/N: every N-th row of the manifest, beginning with the I-th (default: 1/1)")
      .needs(manifest);
  line.add_option("--threads", task.processes, "rows of the manifest that are estimated at once (default: 1)")
      .needs(manifest)
      .between(1, 1000);
  line.add_flag("--resume", task.resume, "keep the rows of the manifest that are answered already").needs(manifest);
  line.add_option("--merge", merged, "estimate nothing; write this CSV file with a row for each row of the manifest")
      .needs(manifest);
}

ExitCode estimate_manifest(ManifestOption& option, bool quiet, const StopRequest& stop) {
  const Manifest manifest = read_manifest(option.file);
  ManifestTask& task = option.task;
  read_shard(option.shard, task);
  if (!option.merged.empty()) {
    write_text(option.merged, merge_manifest(manifest, task.output, task.arguments));
    return ExitCode::answered;
  }
  make_folder(task.output);
  Progress progress(std::cerr, Progress::style_of_stderr(quiet), "estimate");
  const ManifestOutcome out = run_manifest(
      manifest, task, [&](std::size_t over, std::size_t total) { progress.show(over, total); }, stop);
  progress.finish();
  if (!quiet) {
    std::cout << out.answered << " rows answered, " << out.kept << " kept, " << out.failed << " failed, " << out.interrupted
              << " not finished; in " << task.output << "\n";
  }
  if (out.interrupted > 0) return ExitCode::interrupted;
  return out.failed > 0 ? ExitCode::failed : ExitCode::answered;
}

}  // namespace tissue_stiffness
