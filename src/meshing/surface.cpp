#include "meshing/surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "meshing/file_cursor.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

struct Face {
  std::array<int, 3> key;  // ascending corners
  int tet;
  int local;
  bool even;  // the face's own order is an even permutation of the key
};

Face make_face(const Eigen::MatrixXi& tets, int tet, int local) {
  Face face{
      {tets(kTetFaces[local][0], tet), tets(kTetFaces[local][1], tet), tets(kTetFaces[local][2], tet)}, tet, local, true};
  auto order = [&face](int a, int b) {
    if (face.key[a] > face.key[b]) {
      std::swap(face.key[a], face.key[b]);
      face.even = !face.even;
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return face;
}

std::vector<Face> sorted_faces(const Eigen::MatrixXi& tets) {
  std::vector<Face> faces;
  faces.reserve(4 * static_cast<std::size_t>(tets.cols()));
  for (int tet = 0; tet < tets.cols(); ++tet) {
    for (int local = 0; local < 4; ++local) faces.push_back(make_face(tets, tet, local));
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.key != b.key ? a.key < b.key : a.tet < b.tet; });
  return faces;
}

[[noreturn]] void fail_at(const TetMesh& mesh, const Face& face, const std::string& where, const std::string& found,
                          const std::string& allowed) {
  const Eigen::Vector3d centre =
      (mesh.nodes.col(face.key[0]) + mesh.nodes.col(face.key[1]) + mesh.nodes.col(face.key[2])) / 3.0;
  throw InputError(where, found + " at " + format_point(centre), allowed);
}

}  // namespace

void set_boundary_facets(TetMesh& mesh, const std::string& where) {
  const std::vector<Face> faces = sorted_faces(mesh.tets);
  std::vector<Face> boundary;
  for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
    while (end < faces.size() && faces[end].key == faces[begin].key) ++end;
    if (end - begin == 1) boundary.push_back(faces[begin]);
    if (end - begin > 2) {
      fail_at(mesh, faces[begin], where, std::to_string(end - begin) + " tetrahedra on one face", "two at most");
    }
    if (end - begin == 2 && faces[begin].even == faces[begin + 1].even) {
      fail_at(mesh, faces[begin], where,
              "overlapping tetrahedra " + std::to_string(faces[begin].tet) + " and " + std::to_string(faces[begin + 1].tet),
              "tetrahedra on either side of their common face");
    }
  }
  std::sort(boundary.begin(), boundary.end(),
            [](const Face& a, const Face& b) { return a.tet != b.tet ? a.tet < b.tet : a.local < b.local; });
  const int rows = mesh.quadratic() ? 6 : 3;
  mesh.facets.resize(rows, static_cast<Eigen::Index>(boundary.size()));
  mesh.facet_tet.resize(static_cast<Eigen::Index>(boundary.size()));
  for (std::size_t f = 0; f < boundary.size(); ++f) {
    const auto column = static_cast<Eigen::Index>(f);
    mesh.facet_tet[column] = boundary[f].tet;
    for (int i = 0; i < rows; ++i) {
      mesh.facets(i, column) = mesh.tets(kTetFaces[boundary[f].local][i], boundary[f].tet);
    }
  }
}

std::vector<int> surface_nodes(const TetMesh& mesh) {
  std::vector<int> nodes(mesh.facets.data(), mesh.facets.data() + mesh.facets.size());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

double tet_volume(const TetMesh& mesh, int tet) {
  const Eigen::Vector3d x0 = mesh.nodes.col(mesh.tets(0, tet));
  const Eigen::Vector3d a = mesh.nodes.col(mesh.tets(1, tet)) - x0;
  const Eigen::Vector3d b = mesh.nodes.col(mesh.tets(2, tet)) - x0;
  const Eigen::Vector3d c = mesh.nodes.col(mesh.tets(3, tet)) - x0;
  return a.cross(b).dot(c) / 6.0;
}

double mesh_volume(const TetMesh& mesh) {
  double volume = 0.0;
  for (int tet = 0; tet < mesh.tet_count(); ++tet) volume += tet_volume(mesh, tet);
  return volume;
}

Eigen::Vector3d facet_area_vector(const TetMesh& mesh, int facet) {
  const Eigen::Vector3d x0 = mesh.nodes.col(mesh.facets(0, facet));
  const Eigen::Vector3d a = mesh.nodes.col(mesh.facets(1, facet)) - x0;
  const Eigen::Vector3d b = mesh.nodes.col(mesh.facets(2, facet)) - x0;
  return 0.5 * a.cross(b);
}

}  // namespace tissue_stiffness
