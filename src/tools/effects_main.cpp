#include "tools/print_effects.hpp"
#include "tools/run_tool.hpp"

int main(int argc, char** argv) {
  using namespace tissue_stiffness;
  CommandLine line("Prints the library of effects: name, formula, parameters with unit and bounds, source.", "effects");
  bool markdown = false, json = false, quiet = false;
  line.add_flag("--markdown", markdown, "as a page of the documentation");
  line.add_flag("--json", json, "as JSON");
  line.add_flag("--quiet", quiet, "the names alone");
  line.footer("Example: effects --quiet");
  return run_tool(line, argc, argv, [&] {
    if (json) return print_effects_json(std::cout);
    if (markdown) return print_effects_markdown(std::cout);
    if (quiet) return print_effect_names(std::cout);
    print_effects(std::cout);
  });
}
