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

TEST(InsideFolder, IsAskedOfEveryFileOfAModel) {
  const auto refused = [](const std::string& text) {
    try {
      require_files_inside(parse_yaml(text, "model.yaml"), "/data/case", ", or --allow-outside");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused("mesh: {file: mesh.vtk}\neffects:\n- traction: {course: {file: /data/case/push.csv}}\n"), "");
  EXPECT_EQ(refused("mesh: {file: ../mesh.vtk}\n"),
            "model.yaml:1: mesh.file: found ../mesh.vtk; allowed: a file in the folder /data/case, or --allow-outside");
  EXPECT_NE(refused("effects:\n- traction: {course: {file: /etc/passwd}}\n").find("effects[0].traction.course.file"),
            std::string::npos);
  EXPECT_NE(refused("simulation: {loads: {/p: {terms: [{csv: {file: ../a.csv}}]}}}\n").find("../a.csv"), std::string::npos);
}

TEST(InsideFolder, LeavesUnknownKeysUnread) {
  const Value model = parse_yaml("inertia: {file: a.csv}\n", "model.yaml");
  require_files_inside(model, "/data");
  EXPECT_THROW(model.require_all_read(), InputError);
}

}  // namespace
}  // namespace tissue_stiffness
