#include "tissue_stiffness/types/error.hpp"

#include <gtest/gtest.h>

namespace tissue_stiffness {
namespace {

TEST(InputErrorTest, SaysWhereWhatAndWhatIsAllowed) {
  EXPECT_STREQ(InputError("model.yaml: density", "-1", "0 or more").what(),
               "model.yaml: density: found -1; allowed: 0 or more");
}

TEST(InputErrorTest, CutsWhatIsLong) {
  const std::string text = InputError("mesh.vtk: line 2", std::string(3000000, 'x'), "a number").what();
  EXPECT_LT(text.size(), 500U);
  EXPECT_NE(text.find("xxx... (3000000 characters); allowed: a number"), std::string::npos) << text;
  EXPECT_LT(std::string(InputError(std::string(3000000, 'x')).what()).size(), 5000U);
}

TEST(InputErrorTest, CutsBetweenCharacters) {
  std::string found;
  for (int i = 0; i < 200; ++i) found += "\u00e9";  // two bytes each, so 300 bytes end between two of them
  found.insert(0, "x");
  const std::string text = InputError("key", found, "less").what();
  EXPECT_NE(text.find("\u00e9... (401 characters)"), std::string::npos) << text;
}

TEST(InputErrorTest, ReplacesControlCharacters) {
  EXPECT_STREQ(InputError("key", "\x1b[31m\x7f", "text").what(), "key: found ?[31m?; allowed: text");
  EXPECT_STREQ(InputError("key", "\u00e4", "text").what(), "key: found \u00e4; allowed: text");
}

}  // namespace
}  // namespace tissue_stiffness
