#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

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

}  // namespace tissue_stiffness
