#pragma once

#include <map>
#include <string>
#include <utility>

#include "fem/discretisation.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// The geometry of a model: models of one body share it.
struct Body {
  Body(const TetMesh& of, std::map<std::string, Region> with) : mesh(of), fem(mesh), regions(std::move(with)) {}
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;

  TetMesh mesh;
  Discretisation fem;
  std::map<std::string, Region> regions;
};

}  // namespace tissue_stiffness
