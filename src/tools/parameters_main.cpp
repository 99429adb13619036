#include "tools/print_keys.hpp"
#include "tools/run_tool.hpp"

int main(int argc, char** argv) {
  tissue_stiffness::CommandLine line(
      "Prints the keys of a model file and the nodes' parameters: unit, allowed values, default, meaning.", "parameters");
  bool markdown = false;
  line.add_flag("--markdown", markdown, "as a page of the documentation");
  line.footer("Example: parameters --markdown > doc/parameters.md");
  return tissue_stiffness::run_tool(line, argc, argv, [&] {
    markdown ? tissue_stiffness::print_keys_markdown(std::cout) : tissue_stiffness::print_keys(std::cout);
  });
}
