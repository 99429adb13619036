#include "meshing/tet_file_check.hpp"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "meshing/elevate.hpp"
#include "meshing/file_cursor.hpp"
#include "meshing/mesh_limits.hpp"
#include "meshing/quality.hpp"
#include "meshing/surface.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// A tetrahedron whose volume is below this share of its longest edge's cube counts as flat.
constexpr double kFlatShare = 1e-9;

// Numbers the corners first and then the mid-edge nodes, each in the file's order.
TetMesh number_corners_first(const TetFile& input, double scale, const std::string& where) {
  enum class Role : char { unused, mid, corner };
  std::vector<Role> roles(static_cast<std::size_t>(input.nodes.cols()), Role::unused);
  for (Eigen::Index i = input.tets.rows(); i-- > 0;) {
    for (Eigen::Index t = 0; t < input.tets.cols(); ++t) {
      roles[static_cast<std::size_t>(input.tets(i, t))] = i < 4 ? Role::corner : Role::mid;
    }
  }
  const auto unused = std::find(roles.begin(), roles.end(), Role::unused);
  if (unused != roles.end()) {
    const Eigen::Index node = unused - roles.begin();
    throw InputError(
        where,
        "vertex " + std::to_string(node) + " at " + format_point(scale * input.nodes.col(node)) + " in no tetrahedron",
        "vertices that tetrahedra use");
  }
  TetMesh mesh;
  std::vector<int> number(roles.size());
  int next = 0;
  for (const Role role : {Role::corner, Role::mid}) {
    for (std::size_t i = 0; i < roles.size(); ++i) {
      if (roles[i] == role) number[i] = next++;
    }
    if (role == Role::corner) mesh.corner_count = next;
  }
  mesh.nodes.resize(3, input.nodes.cols());
  for (std::size_t i = 0; i < roles.size(); ++i) {
    mesh.nodes.col(number[i]) = scale * input.nodes.col(static_cast<Eigen::Index>(i));
  }
  mesh.tets = input.tets.unaryExpr([&number](int node) { return number[static_cast<std::size_t>(node)]; });
  return mesh;
}

void check_coincident(const TetMesh& mesh, const std::string& where) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  const Eigen::Vector3d centre = mesh.nodes.rowwise().mean();
  for (int i = 0; i < mesh.corner_count; ++i) {
    const Eigen::Vector3f p = (mesh.nodes.col(i) - centre).cast<float>();
    cloud->push_back({p.x(), p.y(), p.z()});
  }
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(cloud);
  std::vector<int> neighbours;
  std::vector<float> squared;
  for (int i = 0; i < mesh.corner_count; ++i) {
    tree.nearestKSearch(i, std::min(4, mesh.corner_count), neighbours, squared);
    for (const int j : neighbours) {
      if (j == i || mesh.nodes.col(i) != mesh.nodes.col(j)) continue;
      throw InputError(where,
                       "vertices " + std::to_string(std::min(i, j)) + " and " + std::to_string(std::max(i, j)) +
                           " both at " + format_point(mesh.nodes.col(i)),
                       "one vertex a place, or the body falls apart there");
    }
  }
}

std::string describe_tet(const TetMesh& mesh, int tet) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) centre += 0.25 * mesh.nodes.col(mesh.tets(i, tet));
  return "tetrahedron " + std::to_string(tet) + " at " + format_point(centre);
}

void swap_handedness(TetMesh& mesh) {
  mesh.tets.row(0).swap(mesh.tets.row(1));
  if (!mesh.quadratic()) return;
  mesh.tets.row(5).swap(mesh.tets.row(6));  // edges 12 and 02
  mesh.tets.row(7).swap(mesh.tets.row(8));  // edges 03 and 13
}

// Returns the tetrahedra's signed volumes, none of which is zero.
Eigen::VectorXd signed_volumes(const TetMesh& mesh, const std::string& where) {
  Eigen::VectorXd volumes(mesh.tet_count());
  for (int tet = 0; tet < mesh.tet_count(); ++tet) {
    volumes[tet] = tet_volume(mesh, tet);
    const double length = edge_lengths(mesh, tet).maxCoeff();
    if (std::abs(volumes[tet]) > kFlatShare * length * length * length) continue;
    throw InputError(where, describe_tet(mesh, tet) + " without volume", "tetrahedra with a positive volume");
  }
  return volumes;
}

void refuse_inverted(const TetMesh& mesh, const Eigen::VectorXd& volumes, const std::string& where) {
  for (int tet = 0; tet < mesh.tet_count(); ++tet) {
    if (volumes[tet] > 0.0) continue;
    throw InputError(where, describe_tet(mesh, tet) + ", which is inverted",
                     "corners 0-3 with (x1-x0) x (x2-x0) . (x3-x0) > 0");
  }
}

void orient(TetMesh& mesh, const std::string& where) {
  const Eigen::VectorXd volumes = signed_volumes(mesh, where);
  if ((volumes.array() < 0.0).all()) {
    swap_handedness(mesh);
  } else {
    refuse_inverted(mesh, volumes, where);
  }
}

// Throws for a facet that is no face of its tetrahedron, with its corners first.
void check_facets(const TetMesh& mesh, const std::string& where) {
  for (Eigen::Index f = 0; f < mesh.facets.cols(); ++f) {
    const auto tet = mesh.tets.col(mesh.facet_tet[f]);
    for (Eigen::Index i = 0; i < mesh.facets.rows(); ++i) {
      const auto nodes = i < 3 ? tet.head(4) : tet.tail(tet.size() - 4);
      if ((nodes.array() == mesh.facets(i, f)).any()) continue;
      throw InputError(where, "facet " + std::to_string(f) + " with node " + std::to_string(mesh.facets(i, f)),
                       "nodes of its tetrahedron " + std::to_string(mesh.facet_tet[f]));
    }
  }
}

}  // namespace

void check_tet_mesh(const TetMesh& mesh, const std::string& where) {
  check_body_size(mesh.nodes, where);
  if (mesh.tet_count() == 0 || mesh.facet_count() == 0) {
    throw InputError(where, "no tetrahedra or no facets", "a body and its boundary");
  }
  if (mesh.corner_count < 4 || mesh.tets.topRows(4).maxCoeff() >= mesh.corner_count) {
    throw InputError(where, "corner_count " + std::to_string(mesh.corner_count), "nodes that hold every corner, first");
  }
  refuse_inverted(mesh, signed_volumes(mesh, where), where);
  check_facets(mesh, where);
}

TetMesh check_tet_file(const TetFile& input, double scale, int order, const std::string& where) {
  if (input.tets.cols() == 0) throw InputError(where, "no tetrahedra", "at least one");
  check_body_size(scale * input.nodes, where);
  TetMesh mesh = number_corners_first(input, scale, where);
  check_coincident(mesh, where);
  orient(mesh, where);
  if (order == 1) drop_mid_nodes(mesh);
  if (order == 2) elevate_to_quadratic(mesh);
  set_boundary_facets(mesh, where);
  return mesh;
}

}  // namespace tissue_stiffness
