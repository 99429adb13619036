#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

namespace tissue_stiffness {

/// A file that is gone with the test. Its name ends with `ending`.
class WrittenFile {
 public:
  WrittenFile(const std::string& ending, const std::string& text) : name(testing::TempDir() + "written" + ending) {
    std::ofstream(name) << text;
  }
  ~WrittenFile() { std::remove(name.c_str()); }
  WrittenFile(const WrittenFile&) = delete;
  WrittenFile& operator=(const WrittenFile&) = delete;

  const std::string name;
};

}  // namespace tissue_stiffness
