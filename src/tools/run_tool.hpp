#pragma once

#include <algorithm>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <type_traits>

#include "tissue_stiffness/types/error.hpp"
#include "tools/command_line.hpp"
#include "tools/exit_code.hpp"
#include "tools/versions.hpp"
#include "types/freed_memory.hpp"

namespace tissue_stiffness {

/// Returns the command line as a reader would write it, with the tool's name and without its folder.
inline std::string join_arguments(const std::string& tool, int argc, char** argv) {
  std::string line = tool;
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  return line;
}

/// Parses the command line and runs a tool. With --help or --version it prints what they ask for instead. The tool returns
/// its exit code, or nothing if it always answers. Wrong arguments or input give one line and exit code 2, other failures
/// one line and exit code 1.
template <typename Tool>
int run_tool(CommandLine& line, int argc, char** argv, const Tool& tool) {
  keep_freed_memory();
  try {
    const CommandLine::Wanted wanted = line.parse({argv + std::min(argc, 1), argv + argc});
    if (wanted == CommandLine::Wanted::help) {
      std::cout << line.help();
      return static_cast<int>(ExitCode::answered);
    }
    if (wanted == CommandLine::Wanted::versions) {
      for (const auto& [name, version] : versions()) std::cout << name << " " << version << "\n";
      return static_cast<int>(ExitCode::answered);
    }
    if constexpr (std::is_void_v<decltype(tool())>) {
      tool();
      return static_cast<int>(ExitCode::answered);
    } else {
      return static_cast<int>(tool());
    }
  } catch (const UsageError& error) {
    std::cerr << line.tool() << ": " << error.what() << " (--help shows the arguments)\n";
    return static_cast<int>(ExitCode::wrong_input);
  } catch (const InputError& error) {
    std::cerr << line.tool() << ": " << error.what() << "\n";
    return static_cast<int>(ExitCode::wrong_input);
  } catch (const std::bad_alloc&) {
    std::cerr << line.tool() << ": the memory is too small for this model or recording\n";
    return static_cast<int>(ExitCode::failed);
  } catch (const std::exception& error) {
    std::cerr << line.tool() << ": " << error.what() << "\n";
    return static_cast<int>(ExitCode::failed);
  }
}

}  // namespace tissue_stiffness
