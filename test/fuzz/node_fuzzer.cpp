// TetGen's two files: the bytes up to the first line of "---" are the nodes, and the rest are the elements.
#include "fuzz_input.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tissue_stiffness;
  const std::string text(reinterpret_cast<const char*>(data), size), line = "\n---\n";
  const std::size_t at = text.find(line);
  const std::string nodes = text.substr(0, at), elements = at == std::string::npos ? "" : text.substr(at + line.size());
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(elements.data());
  fuzz_file(bytes, elements.size(), ".ele", [](const std::string&) {});
  bytes = reinterpret_cast<const std::uint8_t*>(nodes.data());
  return fuzz_file(bytes, nodes.size(), ".node", [](const std::string& file) { load_tet_mesh(file, 1.0, 1); });
}
