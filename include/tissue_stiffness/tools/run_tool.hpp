#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <iostream>

#include "tissue_stiffness/types/error.hpp"
#include "tissue_stiffness/types/freed_memory.hpp"

namespace tissue_stiffness {

/// Parses the command line and runs a tool. Wrong arguments or input: one line and exit code 2; anything else that fails:
/// one line and exit code 1.
inline int run_tool(CLI::App& app, int argc, char** argv, const std::function<void()>& tool) {
  keep_freed_memory();
  try {
    app.parse(argc, argv);
    tool();
    return 0;
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::cerr << app.get_name() << ": " << error.what() << " (--help shows the arguments)\n";
    return 2;
  } catch (const InputError& error) {
    std::cerr << app.get_name() << ": " << error.what() << "\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << app.get_name() << ": " << error.what() << "\n";
    return 1;
  }
}

}  // namespace tissue_stiffness
