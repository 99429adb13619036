#pragma once

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <string>

#include "types/formatted.hpp"

namespace tissue_stiffness {

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
