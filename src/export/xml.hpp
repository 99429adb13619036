#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// Writes one comment for each line. Two hyphens would end a comment, so they are set apart.
inline void write_comments(const std::vector<std::string>& lines, std::ostream& out) {
  for (std::string line : lines) {
    for (std::size_t at = line.find("--"); at != std::string::npos; at = line.find("--", at)) line.replace(at, 2, "- -");
    out << "<!-- " << line << " -->\n";
  }
}

}  // namespace tissue_stiffness
