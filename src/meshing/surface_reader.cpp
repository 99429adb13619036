#include <cstdint>
#include <cstring>

#include "meshing/file_cursor.hpp"
#include "meshing/file_ending.hpp"
#include "meshing/mesh_limits.hpp"
#include "meshing/polygon_files.hpp"
#include "meshing/triangle_surface.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// Surface files hold 32-bit coordinates. Vertices that are closer than their resolution, relative to the body's size, are
// merged.
constexpr double kWeldShare = 1e-6;
constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

TriangleSurface from_points(const std::vector<Eigen::Vector3d>& corners) {
  TriangleSurface surface;
  const auto count = static_cast<Eigen::Index>(corners.size());
  surface.vertices.resize(3, count);
  surface.triangles.resize(3, count / 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    surface.vertices.col(i) = corners[static_cast<std::size_t>(i)];
    surface.triangles(i % 3, i / 3) = static_cast<int>(i);
  }
  return surface;
}

TriangleSurface read_binary_stl(const std::string& bytes, std::size_t count) {
  std::vector<Eigen::Vector3d> corners;
  for (std::size_t t = 0; t < count; ++t) {
    float values[12];  // normal, then three corners; little-endian as the machines we build for
    std::memcpy(values, bytes.data() + kStlHeader + kStlTriangle * t, sizeof(values));
    for (int corner = 1; corner <= 3; ++corner) {
      corners.push_back(Eigen::Map<const Eigen::Vector3f>(values + 3 * corner).cast<double>());
    }
  }
  return from_points(corners);
}

TriangleSurface read_ascii_stl(FileCursor& in) {
  std::vector<Eigen::Vector3d> corners;
  in.line();  // solid NAME
  while (!in.at_end()) {
    const std::string word = in.word();
    if (word == "vertex") {
      const double x = in.number("x"), y = in.number("y"), z = in.number("z");
      corners.emplace_back(x, y, z);
    } else if (word == "endloop" && corners.size() % 3 != 0) {
      in.fail("a facet that is not a triangle", "three vertices a loop");
    } else if (word == "solid" || word == "endsolid") {
      in.line();
    }
  }
  if (corners.size() % 3 != 0) in.fail("the end of the file", "three vertices a facet");
  return from_points(corners);
}

TriangleSurface read_stl(const std::string& file) {
  FileCursor in(file);
  const std::string& bytes = in.bytes();
  std::uint32_t count = 0;
  if (bytes.size() >= kStlHeader) std::memcpy(&count, bytes.data() + kStlHeader - sizeof(count), sizeof(count));
  // Some binary files also start with "solid", so the size decides.
  if (bytes.size() >= kStlHeader && bytes.size() == kStlHeader + kStlTriangle * count) return read_binary_stl(bytes, count);
  if (in.peek() == "solid") return read_ascii_stl(in);
  in.fail(std::to_string(bytes.size()) + " bytes for " + std::to_string(count) + " triangles",
          "a binary STL of 84 + 50 bytes a triangle, or an ASCII one that starts with 'solid'");
}

TriangleSurface read_surface(const std::string& file) {
  const std::string ending = file_ending(file);
  return ending == ".stl" ? read_stl(file) : ending == ".ply" ? read_ply(file) : read_obj(file);
}

}  // namespace

bool is_surface_file(const std::string& file) {
  const std::string ending = file_ending(file);
  return ending == ".stl" || ending == ".ply" || ending == ".obj";
}

TriangleSurface load_surface(const std::string& file, double scale) {
  const std::string where = "mesh file " + file;
  if (!is_surface_file(file)) throw InputError(where, "ending '" + file_ending(file) + "'", ".stl, .ply or .obj");
  TriangleSurface surface = read_surface(file);
  if (surface.triangle_count() == 0) throw InputError(where, "no triangles", "a closed surface");
  surface.vertices *= scale;
  check_body_size(surface.vertices, where);
  const Eigen::Vector3d extent = surface.vertices.rowwise().maxCoeff() - surface.vertices.rowwise().minCoeff();
  surface = weld(surface, kWeldShare * extent.norm());
  check_watertight(surface, where);
  orient_outwards(surface, where);
  return surface;
}

}  // namespace tissue_stiffness
