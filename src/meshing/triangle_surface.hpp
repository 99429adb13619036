#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// A surface of triangles whose corners run counter-clockwise seen from outside.
struct TriangleSurface {
  Eigen::Matrix3Xd vertices;   ///< [m]
  Eigen::Matrix3Xi triangles;  ///< vertex numbers from 0

  int vertex_count() const { return static_cast<int>(vertices.cols()); }
  int triangle_count() const { return static_cast<int>(triangles.cols()); }
};

/// Returns whether load_surface knows the file's ending: .stl, .ply or .obj.
bool is_surface_file(const std::string& file);

/// Reads a surface file (STL, PLY, OBJ; ASCII or binary; polygons are cut into fans). Coordinates are
/// multiplied by `scale` [m per file unit]. The surface is welded, checked to be closed, and oriented. Throws InputError
/// naming file and place.
TriangleSurface load_surface(const std::string& file, double scale);

/// Merges vertices closer than `tolerance` [m] into the first of them. Drops triangles that thereby lose an edge, and
/// vertices that no triangle uses.
TriangleSurface weld(const TriangleSurface& surface, double tolerance);

/// Throws InputError, naming `where` and the place, unless the surface holds triangles with finite coordinates and every
/// edge has exactly two of them.
void check_watertight(const TriangleSurface& surface, const std::string& where);

/// Returns the triangle on the other side of every edge: neighbours(i, t) shares the edge from corner i to corner i + 1 of
/// triangle t. The surface must be watertight.
Eigen::Matrix3Xi triangle_neighbours(const TriangleSurface& surface);

/// Gives the triangles of each connected shell the same orientation, outwards by the shell's volume. Throws InputError for
/// a one-sided shell. The surface must be watertight.
void orient_outwards(TriangleSurface& surface, const std::string& where);

/// Returns the volume that the surface encloses [m^3]. Shells inside an odd number of others count negative, however they
/// are oriented. Shells must not cross.
double enclosed_volume(const TriangleSurface& surface);

/// Returns the number of times that the surface winds around a point (van Oosterom and Strackee 1983 for the solid angle of
/// a triangle).
double winding_number(const TriangleSurface& surface, const Eigen::Vector3d& point);

/// Returns a triangle's outward normal times its area [m^2].
Eigen::Vector3d triangle_area_vector(const TriangleSurface& surface, int triangle);

/// Returns the shell (connected part) of every triangle, numbered from 0.
std::vector<int> shells(const TriangleSurface& surface);

}  // namespace tissue_stiffness
