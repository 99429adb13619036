// What two model files say differently, whatever their layout is.
#include "settings/model_difference.hpp"

#include <gtest/gtest.h>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

const char* const kGiven = R"(# A comment.
mesh: {file: folder/mesh.vtk}
regions: {table: {box: {min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}}}
effects:
  - inertia: {density: 1060}
  - elasticity: {law: linear, young_modulus: {prior: 24e3, factor: 3}, poisson_ratio: 0.45}
  - traction: {region: tool, topic: /tool/wrench}
observations:
  - contour: {image: /left, noise: 3e-4}
  - contour: {image: /right, noise: 3e-4}
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

/// Returns "ENTRY: BEFORE -> AFTER" of each difference.
std::vector<std::string> differences(const std::string& before, const std::string& after) {
  std::vector<std::string> out;
  for (const EntryDifference& d : model_difference(before, after, {"a.yaml", "b.yaml"}))
    out.push_back(d.entry + ": " + d.before + " -> " + d.after);
  return out;
}

using Lines = std::vector<std::string>;

TEST(ModelDifference, IgnoresLayoutAndFolders) {
  EXPECT_EQ(differences(kGiven, kGiven), Lines());
  std::string moved = replaced(kGiven, "# A comment.\n", "");
  moved = replaced(moved, "{file: folder/mesh.vtk}", "\n  file: model_files/mesh.vtk");
  moved = replaced(moved, "24e3", "24000");
  moved = replaced(moved, "-1.0e-6", "-0.000001");
  EXPECT_EQ(differences(kGiven, moved), Lines());
  EXPECT_EQ(differences(kGiven, replaced(kGiven, "folder/mesh.vtk", "folder/other.vtk")),
            (Lines{"mesh.file: folder/mesh.vtk -> folder/other.vtk"}));
}

TEST(ModelDifference, NamesWhatIsAddedRemovedAndChanged) {
  std::string other = replaced(kGiven, "prior: 24e3", "prior: 12e3");
  other = replaced(other, "  - traction: {region: tool, topic: /tool/wrench}\n",
                   "  - viscoelasticity: {gamma: {prior: 1.5, factor: 1.02}}\n");
  other = replaced(other, "/right, noise: 3e-4", "/right, noise: 2e-4");
  other = replaced(other, "max: [1, 1, 1.0e-6]", "max: [1, 2, 1.0e-6]");
  other = replaced(other, "{density: 1060}", "{density: 1060, region: all}");
  EXPECT_EQ(differences(kGiven, other),
            (Lines{"regions.table.box.max: [1, 1, 1e-06] -> [1, 2, 1e-06]", "inertia.region:  -> all",
                   "elasticity.young_modulus.prior: 24000 -> 12000", "traction: {region: tool, topic: /tool/wrench} -> ",
                   "viscoelasticity:  -> {gamma: {prior: 1.5, factor: 1.02}}",
                   "observations.contour#2.noise: 0.0003 -> 0.0002"}));
}

TEST(ModelDifference, ComparesValuesOfDifferentKind) {
  EXPECT_EQ(differences("a: 1", "a: {mean: 1, std: 2}"), (Lines{"a: 1 -> {mean: 1, std: 2}"}));
  EXPECT_EQ(differences("a: [x, y]\nb: ~", "a: [x]\nb: true"), (Lines{"a: [x, y] -> [x]", "b: ~ -> true"}));
  EXPECT_EQ(differences("", "a: 1"), (Lines{": ~ -> {a: 1}"}));
}

TEST(ModelDifference, NamesTheTextThatIsNoYaml) {
  try {
    model_difference("a: 1", "a: [1", {"a.yaml", "b.yaml"});
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("b.yaml:"), 0U) << error.what();
  }
}

}  // namespace
}  // namespace tissue_stiffness
