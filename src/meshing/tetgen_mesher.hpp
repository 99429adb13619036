#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "meshing/triangle_surface.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {

/// Fills a surface with 4-node tetrahedra by means of TetGen (H. Si 2015, TetGen, a Delaunay-based quality tetrahedral mesh
/// generator). Space inside an odd number of the surface's shells is body, the rest is cavity.
///
/// `max_edge_length` > 0: edges have about that length [m], and plane parts of the surface are triangulated again. 0: the
/// surface keeps its triangles, and the inside follows them. `keep_triangles`: the surface keeps its triangles in either
/// case. Throws InputError naming `where` and the place for a surface that crosses itself, and for a build without TetGen.
/// `checkpoint` is called ten times a second; an exception from it ends the meshing.
TetFile fill_surface(
    const TriangleSurface& surface, double max_edge_length, bool keep_triangles, const std::string& where,
    const std::function<void()>& checkpoint = [] {});

/// Returns whether this build has TetGen (CMake option TISSUE_STIFFNESS_TETGEN).
bool has_tetgen();

}  // namespace tissue_stiffness
