#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Pairs of corners whose edges hold the local nodes 4-9 of a 10-node tetrahedron.
constexpr std::array<std::array<int, 2>, 6> kTetEdges = {{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// Faces of a tetrahedron, counter-clockwise seen from outside: corners, then the mid nodes of 01, 12, 20.
constexpr std::array<std::array<int, 6>, 4> kTetFaces = {
    {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}}};

/// Sets `facets` and `facet_tet` to the faces that only one tetrahedron has, in the order of their tetrahedra. Throws
/// InputError, naming `where` and the place, for a face of more than two tetrahedra or of two that overlap.
void set_boundary_facets(TetMesh& mesh, const std::string& where);

/// Returns the nodes of the boundary facets, ascending.
std::vector<int> surface_nodes(const TetMesh& mesh);

/// Returns the volume of the straight-edged tetrahedra through the corners, the sum of (x1-x0) x (x2-x0) . (x3-x0) / 6
/// [m^3].
double mesh_volume(const TetMesh& mesh);

/// Returns the signed volume of one tetrahedron's corners [m^3].
double tet_volume(const TetMesh& mesh, int tet);

/// Returns the outward normal of a facet's corners times its area [m^2].
Eigen::Vector3d facet_area_vector(const TetMesh& mesh, int facet);

}  // namespace tissue_stiffness
