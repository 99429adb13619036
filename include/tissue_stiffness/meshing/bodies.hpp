#pragma once

#include <Eigen/Core>

#include "tissue_stiffness/meshing/revolution_profile.hpp"
#include "tissue_stiffness/meshing/triangle_surface.hpp"
#include "tissue_stiffness/types/camera.hpp"
#include "tissue_stiffness/types/contour.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Closed surface of near-equilateral triangles on a body of revolution: rings at equal arc length along the profile, each
/// divided into equal parts, and one vertex at each pole; edges about `edge_length` [m].
TriangleSurface revolution_surface(const RevolutionProfile& profile, double edge_length);

/// Moves the mid-edge nodes of the boundary onto the body of revolution, and back where an element would lose its positive
/// Jacobian. Returns how many were put back.
int curve_boundary(TetMesh& mesh, const RevolutionProfile& profile);

/// Prism of thickness `depth` [m] along the viewing direction, centred in the plane through the model's origin that faces
/// the camera (slice: the image plane). Outline points where the body widens away from the image's centre belong to its
/// near face, others to its far face, which is where a pinhole sees them. Corners of the outline are found, the sides
/// between them fitted, with edges of at most `edge_length` [m]. Throws InputError for a body that reaches behind the
/// camera.
TriangleSurface extruded_surface(const Contour& contour, const Camera& camera, double depth, double edge_length);

}  // namespace tissue_stiffness
