// A course: rows of time and values, and of poses.
#include "effects/course.hpp"
#include "fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tissue_stiffness;
  for (const LoadInput::Kind kind : {LoadInput::Kind::pressure, LoadInput::Kind::pose}) {
    fuzz_file(data, size, ".csv", [&](const std::string& file) { Course::from_csv(file, kind).value(0.5, 0); });
  }
  return 0;
}
