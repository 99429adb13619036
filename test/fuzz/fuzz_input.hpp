#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

/// Calls `read` with the bytes. An InputError is what a reader owes to a wrong input; everything else ends the fuzzer.
template <typename Read>
int fuzz_text(const std::uint8_t* data, std::size_t size, const Read& read) {
  try {
    read(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const InputError&) {
  }
  return 0;
}

/// Writes the bytes to a file in memory with this ending, and calls `read` with its name.
template <typename Read>
int fuzz_file(const std::uint8_t* data, std::size_t size, const std::string& ending, const Read& read) {
  static const std::string stem = "/dev/shm/tissue_stiffness_fuzz_" + std::to_string(getpid());
  const std::string file = stem + ending;
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return fuzz_text(data, size, [&](const std::string&) { read(file); });
}

}  // namespace tissue_stiffness
