#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/types/stiffness_map.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Returns `map.vtk` (legacy ASCII unstructured grid). It is the body at rest with cell data `patch` (-1: not mapped),
/// `young_modulus`, `lower95`, `upper95` [Pa] (0 where not mapped) and `identified` (0 or 1).
std::string map_vtk(const StiffnessMap& map, const TetMesh& mesh);

/// Reads the cell data `patch` of such a file. Throws InputError where it does not hold a number for each tetrahedron.
std::vector<int> read_map_patches(const std::string& file);

}  // namespace tissue_stiffness
