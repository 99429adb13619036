#pragma once

#include <cstdint>
#include <string>

namespace tissue_stiffness {

/// Returns the bytes of a file. `where` names it in errors, and `allowed` says what it should be. Throws InputError for a
/// file that is not there or not a regular one, which may have no end, and for one that is larger than `most` bytes.
std::string read_file(const std::string& file, const std::string& where, const std::string& allowed, std::uintmax_t most);

}  // namespace tissue_stiffness
