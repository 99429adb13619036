#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "workbench.hpp"

namespace tissue_stiffness {

/// Of a command.
struct Outcome {
  int code;
  std::string text;  ///< standard output and error
};

inline Outcome run(const std::string& command) {
  Outcome outcome{-1, ""};
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.text.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  return outcome;
}

/// Of a tool, with its arguments.
inline Outcome call(const std::string& command) {
  return run(std::string(TISSUE_STIFFNESS_TOOLS) + "/" + command);
}

/// Exit code 2 and one line with all the words.
inline ::testing::AssertionResult refuses(const std::string& command, const std::vector<std::string>& words) {
  Outcome outcome = call(command);
  if (outcome.code != 2) return ::testing::AssertionFailure() << "exit code " << outcome.code << ": " << outcome.text;
  if (!outcome.text.empty() && outcome.text.back() == '\n') outcome.text.pop_back();
  return says(outcome.text, words);
}

}  // namespace tissue_stiffness
