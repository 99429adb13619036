#pragma once

#include <Eigen/Core>

#include "meshing/revolution_profile.hpp"
#include "meshing/triangle_surface.hpp"
#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/contour.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Returns a closed surface of nearly equilateral triangles on a body of revolution. It has rings at equal arc length along
/// the profile, each divided into equal parts, and one vertex at each pole. The edges are about `edge_length` [m] long.
TriangleSurface revolution_surface(const RevolutionProfile& profile, double edge_length);

/// Moves the mid-edge nodes of the boundary onto the body of revolution, less far where an element would be bent too much.
void curve_boundary(TetMesh& mesh, const RevolutionProfile& profile);

/// Returns a prism of thickness `depth` [m] along the viewing direction. It is centred in the plane through the model's
/// origin that faces the camera (for a slice in the image plane). Outline points where the body widens away from the
/// image's centre belong to its near face, the others to its far face. This is where a pinhole sees them. Corners of the
/// outline are found and the sides between them fitted, with edges of at most `edge_length` [m]. Throws InputError for a
/// body that reaches behind the camera.
TriangleSurface extruded_surface(const Contour& contour, const Camera& camera, double depth, double edge_length);

}  // namespace tissue_stiffness
