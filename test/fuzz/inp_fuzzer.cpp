// A tetrahedral mesh of this format, with all its checks.
#include "fuzz_input.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tissue_stiffness;
  return fuzz_file(data, size, ".inp", [](const std::string& file) { load_tet_mesh(file, 1.0, 2); });
}
