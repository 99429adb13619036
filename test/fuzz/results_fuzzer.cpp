// What `estimate` left: a results.json, and the patches of a map.vtk.
#include "fuzz_input.hpp"
#include "report/map_vtk.hpp"
#include "report/read_results.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tissue_stiffness;
  fuzz_file(data, size, ".json", [](const std::string& file) { read_results(file); });
  return fuzz_file(data, size, ".vtk", [](const std::string& file) { read_map_patches(file); });
}
