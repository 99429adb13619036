#include "types/read_file.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kMegabyte = 1e6;

std::string megabytes(std::uintmax_t bytes) {
  return std::to_string(static_cast<std::uintmax_t>(static_cast<double>(bytes) / kMegabyte)) + " MB";
}

}  // namespace

std::string read_file(const std::string& file, const std::string& where, const std::string& allowed, std::uintmax_t most) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw InputError(where, "no readable file", allowed);
  if (!std::filesystem::is_regular_file(status))
    throw InputError(where, "no readable file (a folder or a device)", allowed);
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > most) throw InputError(where, megabytes(size), allowed + " of at most " + megabytes(most));
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream || stream.bad()) throw InputError(where, "no readable file", allowed);
  return bytes;
}

}  // namespace tissue_stiffness
