#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace tissue_stiffness {

/// Returns a text by a pattern of std::snprintf.
template <typename... Arguments>
std::string formatted(const char* pattern, Arguments... arguments) {
  const int size = std::snprintf(nullptr, 0, pattern, arguments...);
  if (size < 0) return "";
  std::string text(static_cast<std::size_t>(size) + 1, '\0');  // with the end that snprintf writes
  std::snprintf(&text[0], text.size(), pattern, arguments...);
  text.pop_back();
  return text;
}

}  // namespace tissue_stiffness
