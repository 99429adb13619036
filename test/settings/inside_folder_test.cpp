#include "settings/inside_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;

TEST(InsideFolder, ResolvesWhatIsInsideAndRefusesTheRest) {
  const fs::path root = fs::weakly_canonical(testing::TempDir()) / "inside_folder_test", folder = root / "data";
  fs::create_directories(folder / "deep");
  std::ofstream(root / "secret.csv") << "1";
  fs::create_symlink(root / "secret.csv", folder / "link.csv");
  EXPECT_EQ(require_inside("a.csv", folder.string(), "course"), (folder / "a.csv").string());
  EXPECT_EQ(require_inside("deep/../a.csv", folder.string(), "course"), (folder / "a.csv").string());
  EXPECT_EQ(require_inside((folder / "a.csv").string(), folder.string(), "course"), (folder / "a.csv").string());
  for (const std::string outside : {"../secret.csv", "deep/../../secret.csv", "/etc/passwd", "link.csv", "", "."})
    EXPECT_THROW(require_inside(outside, folder.string(), "course"), InputError) << outside;
  EXPECT_THROW(require_inside((root / "data_of_others.csv").string(), folder.string(), "course"), InputError);
  fs::remove_all(root);
}

}  // namespace
}  // namespace tissue_stiffness
