#include "tools/read_text.hpp"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace tissue_stiffness {

std::string read_text(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream, nullptr, false);
}

}  // namespace tissue_stiffness
