#pragma once

#include <string>

#include "meshing/triangle_surface.hpp"

namespace tissue_stiffness {

/// Reads the vertices and faces of a Wavefront OBJ file; other lines are left out. Polygons are cut into fans. Throws
/// InputError naming file and line.
TriangleSurface read_obj(const std::string& file);

/// Reads the vertices (x, y, z) and faces (vertex_indices or vertex_index) of a PLY file, ASCII or binary of either byte
/// order. Other properties and elements are left out, and polygons are cut into fans. Throws InputError naming the file.
TriangleSurface read_ply(const std::string& file);

}  // namespace tissue_stiffness
