#pragma once

#include <string>
#include <vector>

#include "meshing/box_mesh.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

/// Bar of 0.10 x 0.02 x 0.02 m along x, 10-node tetrahedra.
inline TetMesh bar_mesh(int cells_x = 4, int cells_y = 1, int cells_z = 1) {
  return make_box_mesh({0.10, 0.02, 0.02}, cells_x, cells_y, cells_z, 2);
}

/// Model file of a body in the box of bar_mesh, one line an effect ("gravity: {acceleration: [0, 0, -9.81]}"). Regions:
/// `clamp` (x = 0), `tip` (x = 0.1), `top` (z = 0.02), `near` and `far` half, `skin` (everything). `observations` lists its
/// entries; `rest` holds further sections. Its recordings come from the same mesh, so no error of the mesh is looked for,
/// and its inputs are exact.
inline ModelSettings box_settings(const std::vector<std::string>& effects,
                                  const std::string& observations = "[{vertices: {topic: /vertices, noise: 1.0e-4}}]",
                                  const std::string& rest = "") {
  std::string text =
      "mesh: {file: bar.vtk, discretisation_error: false}\n"
      "regions:\n"
      "  clamp: {box: {min: [-1, -1, -1], max: [1.0e-6, 1, 1]}}\n"
      "  tip: {box: {min: [0.099999, -1, -1], max: [1, 1, 1]}}\n"
      "  top: {box: {min: [-1, -1, 0.019999], max: [1, 1, 1]}}\n"
      "  near: {box: {min: [-1, -1, -1], max: [0.05, 1, 1]}}\n"
      "  far: {box: {min: [0.05, -1, -1], max: [1, 1, 1]}}\n"
      "  skin: {box: {min: [-1, -1, -1], max: [1, 1, 1]}}\n"
      "effects:\n";
  for (const std::string& effect : effects) text += "- " + effect + "\n";
  text += "observations: " + observations + "\ninputs: exact\n" + rest;
  return read_model(parse_yaml(text, "model.yaml"), "");
}

/// The message of the InputError that `call` throws; empty when it throws none.
template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace tissue_stiffness
