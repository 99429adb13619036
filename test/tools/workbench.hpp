#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "meshing/box_mesh.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

/// A folder of its own for each test, with the mesh of a cantilever: 10 x 2 x 2 cm, held at x = 0.
class Workbench : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "tissue_stiffness_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    save_mesh(make_box_mesh({0.1, 0.02, 0.02}, 5, 1, 1, 1), path("bar.vtk"));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }

  std::string read(const std::string& name) const {
    std::ifstream stream(path(name));
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// Model of the clamped bar; `regions` and `effects` stand behind those of every bar, `rest` holds the observations
  /// and what follows them.
  std::string write_bar(const std::string& name, const std::string& modulus, const std::string& regions,
                        const std::string& effects, const std::string& rest) const {
    return write(name,
                 "mesh: {file: bar.vtk, discretisation_error: false}\n"  // the recordings come from this very mesh
                 "regions: {clamp: {box: {min: [-1.0e-6, -1, -1], max: [1.0e-6, 1, 1]}}" +
                     regions +
                     "}\n"
                     "effects:\n"
                     "- inertia: {density: 1060}\n"
                     "- elasticity: {law: linear, young_modulus: " +
                     modulus +
                     ", poisson_ratio: 0.45}\n"
                     "- fixed: {region: clamp}\n" +
                     effects + "observations:\n" + rest);
  }

  /// Model of the bar under gravity; `modulus` and `observations` as in a model file, `more` further keys.
  std::string write_model(const std::string& name, const std::string& modulus, const std::string& observations,
                          const std::string& more = "") const {
    return write_bar(name, modulus, "", "- gravity: {acceleration: [0, 0, -9.81]}\n", observations + more);
  }

  static std::string vertices() { return "- vertices: {topic: /tissue/vertices, noise: 2e-4}\n"; }
  static std::string contour() {
    return "- contour: {image: /camera/image_raw, camera_info: /camera/camera_info, noise: 3e-4}\n";
  }

  /// A camera that sees the bar from the side, for a scene of 0.4 s.
  static std::string filmed() {
    return "simulation: {duration: 0.4, rate: 50, step: 0.001, sensors: {/camera/image_raw: {size: [480, 240], "
           "focal_length: 3000, position: [0.05, -1, 0.005], target: [0.05, 0, 0.005]}}}\n";
  }
  /// What hears of no progress.
  static void nothing(std::size_t, std::size_t) {}

  std::string folder_;
};

/// The message of the InputError that `call` throws; empty when it throws none.
template <typename Call>
std::string input_error(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Whether a one-line message holds all the words.
inline ::testing::AssertionResult says(const std::string& message, const std::vector<std::string>& words) {
  if (message.find('\n') != std::string::npos) return ::testing::AssertionFailure() << "more than one line: " << message;
  for (const std::string& word : words) {
    if (message.find(word) == std::string::npos)
      return ::testing::AssertionFailure() << "no '" << word << "' in: " << message;
  }
  return ::testing::AssertionSuccess();
}

}  // namespace tissue_stiffness
