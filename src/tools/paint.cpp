#include "tools/paint.hpp"

#include <unistd.h>

#include <cstdlib>

namespace tissue_stiffness {

Paint Paint::for_stdout() {
  const char *refused = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
  const bool can = terminal != nullptr && std::string(terminal) != "dumb";
  return Paint(isatty(STDOUT_FILENO) != 0 && can && (refused == nullptr || *refused == '\0'));
}

std::string Paint::in(const char* code, const std::string& text) const {
  return on_ ? std::string("\033[") + code + "m" + text + "\033[0m" : text;
}

}  // namespace tissue_stiffness
