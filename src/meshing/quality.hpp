#pragma once

#include <Eigen/Core>
#include <string>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Shape of a mesh's tetrahedra. The radius ratio is 3 r / R, where r is the inscribed sphere's radius and R the
/// circumscribed sphere's. It is 1 for a regular tetrahedron and 0 for a flat one (Shewchuk 2002, What is a good linear
/// finite element?).
struct MeshQuality {
  double least_radius_ratio = 0.0;
  double mean_radius_ratio = 0.0;
  double least_dihedral_angle = 0.0;  ///< [rad]
  double least_jacobian_ratio = 0.0;  ///< 10-node: least over greatest Jacobian at an element's nodes; 1 when straight
  double mean_edge_length = 0.0;      ///< mean over the tetrahedra's edges between corners [m]
  double volume = 0.0;                ///< volume of the straight-edged tetrahedra [m^3]
  int worst_tet = 0;                  ///< tetrahedron with the least radius ratio
};

/// Computes the quality. Throws InputError for an empty mesh.
MeshQuality measure_quality(const TetMesh& mesh);

/// Returns one line with counts, edge length, volume and quality.
std::string describe_quality(const TetMesh& mesh, const MeshQuality& quality);

/// Returns the lengths of the edges between a tetrahedron's corners, in the order of kTetEdges [m].
Eigen::Array<double, 6, 1> edge_lengths(const TetMesh& mesh, int tet);

/// Returns the Jacobian determinants of a tetrahedron's map from the reference element at its nodes: 1 value (4-node) or 10
/// [m^3].
Eigen::VectorXd node_jacobians(const TetMesh& mesh, int tet);

}  // namespace tissue_stiffness
