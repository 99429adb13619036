#include <iostream>
#include <string>
#include <vector>

#include "report/comparison.hpp"
#include "report/write_results.hpp"
#include "tools/run_tool.hpp"

int main(int argc, char** argv) {
  using namespace tissue_stiffness;
  CommandLine line("Shows runs of `estimate` beside each other, on one page.", "compare");
  std::vector<std::string> folders;
  std::string output;
  bool quiet = false;
  line.add_positional("RUNS", folders, "folders that `estimate` wrote, two or more").required().count(2, 100);
  line.add_option("-o,--output", output, "the page, an HTML file").required();
  line.add_flag("--quiet", quiet, "no word about what was written");
  line.footer("Example: compare before after -o compare.html");
  return run_tool(line, argc, argv, [&] {
    std::vector<ComparedRun> runs;
    for (const std::string& folder : folders) runs.push_back(read_run(folder));
    write_text(output, comparison_html(runs, join_arguments("compare", argc, argv), versions()));
    if (!quiet) std::cout << "written " << output << "\n";
  });
}
