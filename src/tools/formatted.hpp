#pragma once

#include <algorithm>
#include <cstddef>
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

/// Puts blanks before a text until it has so many characters. A pattern would count the bytes of a µ.
inline std::string right_aligned(const std::string& text, std::size_t width) {
  const auto characters = static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
  return std::string(width - std::min(width, characters), ' ') + text;
}

template <typename... Arguments>
void print_line(std::ostream& out, const char* pattern, Arguments... arguments) {
  out << formatted(pattern, arguments...) << "\n";
}

}  // namespace tissue_stiffness
