#pragma once

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Returns the mesh with its surface `outward` [m] further out, or in where it is negative. Each facet moves along its
/// normal by this distance, as closely as its corners allow: with area vectors a_f n_f, a corner moves by the smallest d
/// that minimises sum_f a_f (n_f . d - outward)^2. So edges and corners of a block stay sharp. A mid-edge node moves by the
/// mean of its edge's ends. The inside does not move, so `outward` has to be a small part of the edges' lengths.
TetMesh offset_surface(const TetMesh& mesh, double outward);

/// Returns the shortest edge between two corners of a tetrahedron [m].
double shortest_edge(const TetMesh& mesh);

}  // namespace tissue_stiffness
