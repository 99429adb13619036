// A mesh of VTK's XML format, with all its checks. VTK reads it in another process, whose end must not be ours.
#include "fuzz_input.hpp"
#include "meshing/tet_file_check.hpp"
#include "vtu/vtu_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tissue_stiffness;
  return fuzz_file(data, size, ".vtu", [](const std::string& file) { check_tet_file(read_vtu(file), 1.0, 2, file); });
}
