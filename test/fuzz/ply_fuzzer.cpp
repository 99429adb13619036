// A surface of this format.
#include "fuzz_input.hpp"
#include "meshing/triangle_surface.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tissue_stiffness;
  return fuzz_file(data, size, ".ply", [](const std::string& file) { load_surface(file, 0.001); });
}
