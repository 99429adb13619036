#include <pcl/PolygonMesh.h>
#include <pcl/console/print.h>
#include <pcl/io/obj_io.h>
#include <pcl/io/ply_io.h>

#include <cstdint>
#include <cstring>

#include "meshing/file_cursor.hpp"
#include "meshing/file_ending.hpp"
#include "meshing/mesh_limits.hpp"
#include "meshing/triangle_surface.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/read_file.hpp"

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

Eigen::Vector3d cloud_point(const pcl::PCLPointCloud2& cloud, std::size_t index, const std::string& where) {
  static const char* const kAxes[] = {"x", "y", "z"};
  Eigen::Vector3d point;
  for (int axis = 0; axis < 3; ++axis) {
    const pcl::PCLPointField* field = nullptr;
    for (const pcl::PCLPointField& candidate : cloud.fields) {
      if (candidate.name == kAxes[axis]) field = &candidate;
    }
    if (field == nullptr) throw InputError(where, "vertices without " + std::string(kAxes[axis]), "x, y and z");
    const std::uint8_t* data = cloud.data.data() + index * cloud.point_step + field->offset;
    if (field->datatype == pcl::PCLPointField::FLOAT64) {
      std::memcpy(&point[axis], data, sizeof(double));
    } else {
      float value = 0.0F;
      std::memcpy(&value, data, sizeof(float));
      point[axis] = static_cast<double>(value);
    }
  }
  return point;
}

TriangleSurface from_polygons(const pcl::PolygonMesh& mesh, const std::string& where) {
  const auto count = static_cast<std::size_t>(mesh.cloud.width) * mesh.cloud.height;
  TriangleSurface surface;
  surface.vertices.resize(3, static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    surface.vertices.col(static_cast<Eigen::Index>(i)) = cloud_point(mesh.cloud, i, where);
  }
  std::vector<Eigen::Vector3i> triangles;
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    const auto& corners = mesh.polygons[p].vertices;
    for (const auto corner : corners) {
      if (static_cast<std::size_t>(corner) < count) continue;
      throw InputError(where, "vertex " + std::to_string(corner) + " in polygon " + std::to_string(p),
                       "vertices below " + std::to_string(count));
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      triangles.emplace_back(static_cast<int>(corners[0]), static_cast<int>(corners[i]), static_cast<int>(corners[i + 1]));
    }
  }
  surface.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t) surface.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return surface;
}

// Silences PCL, which logs its own messages about a file. Our message is the one that counts.
class QuietPcl {
 public:
  QuietPcl() : level_(pcl::console::getVerbosityLevel()) { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  ~QuietPcl() { pcl::console::setVerbosityLevel(level_); }
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;

 private:
  pcl::console::VERBOSITY_LEVEL level_;
};

TriangleSurface read_with_pcl(const std::string& file, const std::string& where) {
  check_file(file, where, "an existing surface file", kLargestMeshFile);
  const QuietPcl quiet;
  pcl::PolygonMesh mesh;
  const bool ply = file_ending(file) == ".ply";
  int status = -1;
  std::string reason = "content that PCL cannot read";
  try {
    status = ply ? pcl::io::loadPLYFile(file, mesh) : pcl::io::loadOBJFile(file, mesh);
  } catch (const std::exception& error) {
    reason += std::string(" (") + error.what() + ")";
  }
  if (status < 0) throw InputError(where, reason, ply ? "a PLY file with vertices and faces" : "an OBJ file with v and f");
  return from_polygons(mesh, where);
}

}  // namespace

bool is_surface_file(const std::string& file) {
  const std::string ending = file_ending(file);
  return ending == ".stl" || ending == ".ply" || ending == ".obj";
}

TriangleSurface load_surface(const std::string& file, double scale) {
  const std::string where = "mesh file " + file;
  if (!is_surface_file(file)) throw InputError(where, "ending '" + file_ending(file) + "'", ".stl, .ply or .obj");
  TriangleSurface surface = file_ending(file) == ".stl" ? read_stl(file) : read_with_pcl(file, where);
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
