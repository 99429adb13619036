#include "types/read_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

std::string refusal(const std::string& file, std::uintmax_t most = 1000) {
  try {
    read_file(file, "course " + file, "a CSV file", most);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ReadFile, ReturnsTheBytes) {
  const std::string file = testing::TempDir() + "read_file_test.csv";
  const std::string bytes("0 1\n\0\xff", 6);
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_EQ(read_file(file, "course", "a CSV file", 6), bytes);
}

TEST(ReadFile, RefusesWhatIsNoFileOrHasNoEnd) {
  EXPECT_EQ(refusal("/no/such.csv"), "course /no/such.csv: found no readable file; allowed: a CSV file");
  for (const char* path : {"/tmp", "/dev/zero"}) {
    EXPECT_NE(refusal(path).find("no readable file (a folder or a device)"), std::string::npos) << refusal(path);
  }
}

TEST(ReadFile, RefusesWhatIsTooLarge) {
  const std::string file = testing::TempDir() + "read_file_test.large";
  std::ofstream(file) << std::string(3000000, ' ');
  EXPECT_EQ(refusal(file, 2000000), "course " + file + ": found 3 MB; allowed: a CSV file of at most 2 MB");
}

}  // namespace
}  // namespace tissue_stiffness
