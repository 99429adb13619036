// Files are written whole or not at all.
#include "types/pending_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <stdexcept>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;

class PendingFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "tissue_stiffness_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string read(const std::string& name) const {
    std::ifstream stream(path(name));
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::ptrdiff_t count() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  fs::path folder_;
};

TEST_F(PendingFiles, ReplaceTheOldOneWhenTheyAreWhole) {
  write_file(path("a"), [](std::ostream& out) { out << "old"; });
  write_file(path("a"), [&](std::ostream& out) {
    out << "ne" << std::flush;
    EXPECT_EQ(read("a"), "old") << "nobody sees half of it";
    out << "w";
  });
  EXPECT_EQ(read("a"), "new");
  EXPECT_EQ(count(), 1);
}

TEST_F(PendingFiles, LeaveTheOldOneWhereTheWriterFails) {
  write_file(path("a"), [](std::ostream& out) { out << "old"; });
  const auto fail = [](std::ostream& out) {
    out << "half" << std::flush;
    throw std::runtime_error("failed");
  };
  EXPECT_THROW(write_file(path("a"), fail), std::runtime_error);
  EXPECT_THROW(write_file(path("b"), fail), std::runtime_error);
  EXPECT_EQ(read("a"), "old");
  EXPECT_EQ(count(), 1) << "neither b nor a temporary file";
}

TEST_F(PendingFiles, AreRefusedByName) {
  const auto nothing = [](std::ostream&) {};
  fs::create_directory(path("folder"));
  for (const std::string name : {"none/a", "folder"}) {
    try {
      write_file(path(name), nothing);
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(path(name)), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(count(), 1) << "no temporary file";
}

TEST_F(PendingFiles, MayBeReadByWhoMayReadOtherNewFiles) {
  std::ofstream(path("other")) << "x";
  write_file(path("a"), [](std::ostream& out) { out << "x"; });
  struct stat other, own;
  ASSERT_EQ(stat(path("other").c_str(), &other), 0);
  ASSERT_EQ(stat(path("a").c_str(), &own), 0);
  EXPECT_EQ(own.st_mode, other.st_mode);
}

TEST_F(PendingFiles, DevicesAreWrittenDirectly) {
  EXPECT_NO_THROW(write_file("/dev/null", [](std::ostream& out) { out << "x"; }));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace tissue_stiffness
