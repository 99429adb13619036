#pragma once

#include <cstdio>
#include <ostream>
#include <string>

namespace tissue_stiffness {

/// Returns a line of at most 255 characters, by a pattern of std::snprintf.
template <typename... Arguments>
std::string formatted(const char* pattern, Arguments... arguments) {
  char line[256];
  std::snprintf(line, sizeof line, pattern, arguments...);
  return line;
}

template <typename... Arguments>
void print_line(std::ostream& out, const char* pattern, Arguments... arguments) {
  out << formatted(pattern, arguments...) << "\n";
}

}  // namespace tissue_stiffness
