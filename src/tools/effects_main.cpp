#include "tissue_stiffness/tools/print_effects.hpp"
#include "tissue_stiffness/tools/run_tool.hpp"

int main(int argc, char** argv) {
  CLI::App app("Prints the library of effects: name, formula, parameters with unit and bounds, source.", "effects");
  bool markdown = false;
  app.add_flag("--markdown", markdown, "as a page of the documentation");
  return tissue_stiffness::run_tool(app, argc, argv, [&] {
    markdown ? tissue_stiffness::print_effects_markdown(std::cout) : tissue_stiffness::print_effects(std::cout);
  });
}
