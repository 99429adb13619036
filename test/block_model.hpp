#pragma once

#include <string>
#include <vector>

#include "meshing/box_mesh.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// Block of 20 x 20 x 20 mm, 10-node tetrahedra.
inline TetMesh block_mesh(int cells = 2) {
  return make_box_mesh({0.02, 0.02, 0.02}, cells, cells, cells, 2);
}

/// Model file of a block that stands on its `bottom`; a tool may touch its `top`. One line an effect.
inline ModelSettings block_settings(const std::vector<std::string>& effects) {
  std::string text =
      "mesh: {file: block.vtk, discretisation_error: false}\n"
      "regions:\n"
      "  bottom: {box: {min: [-1, -1, -1], max: [1, 1, 1.0e-6]}}\n"
      "  top: {box: {min: [-1, -1, 0.019999], max: [1, 1, 1]}}\n"
      "effects:\n"
      "- inertia: {density: 1000}\n"
      "- fixed: {region: bottom}\n";
  for (const std::string& effect : effects) text += "- " + effect + "\n";
  text += "observations: [{vertices: {topic: /vertices, noise: 1.0e-4}}]\ninputs: exact\n";
  return read_model(parse_yaml(text, "model.yaml"), "");
}

/// A tool that touches its top, with further keys.
inline std::string touching(const std::string& tool) {
  return "tool_contact: {region: top, topic: /pose, smoothing: 0, " + tool + "}";
}

}  // namespace tissue_stiffness
