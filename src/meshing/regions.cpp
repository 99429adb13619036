#include <algorithm>
#include <functional>
#include <set>

#include "meshing/coarsen.hpp"
#include "meshing/refine.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Inside = std::function<bool(const Eigen::Vector3d&)>;

struct InsideOf {
  Inside operator()(const BoxShape& s) const {
    return
        [s](const Eigen::Vector3d& x) { return (x.array() >= s.min.array()).all() && (x.array() <= s.max.array()).all(); };
  }
  Inside operator()(const SphereShape& s) const {
    return [s](const Eigen::Vector3d& x) { return (x - s.center).norm() <= s.radius; };
  }
  Inside operator()(const EllipsoidShape& s) const {
    return [s](const Eigen::Vector3d& x) { return ((x - s.center).array() / s.radii.array()).matrix().norm() <= 1.0; };
  }
  Inside operator()(const HalfSpaceShape& s) const {
    return [s](const Eigen::Vector3d& x) { return (x - s.point).dot(s.normal) <= 0.0; };
  }
  Inside operator()(const VertexShape&) const { return nullptr; }
};

Eigen::Vector3d centroid(const TetMesh& mesh, int tet) {
  return 0.25 * (mesh.nodes.col(mesh.tets(0, tet)) + mesh.nodes.col(mesh.tets(1, tet)) + mesh.nodes.col(mesh.tets(2, tet)) +
                 mesh.nodes.col(mesh.tets(3, tet)));
}

// Returns the listed corners and the mid-edge nodes between them.
std::vector<char> listed_nodes(const VertexShape& shape, const TetMesh& mesh, const std::string& where) {
  std::vector<char> in(static_cast<std::size_t>(mesh.node_count()), 0);
  for (const int vertex : shape.vertices) {
    if (vertex < 0 || vertex >= mesh.corner_count) {
      throw InputError(where + ".vertices", std::to_string(vertex), "0 to " + std::to_string(mesh.corner_count - 1));
    }
    in[static_cast<std::size_t>(vertex)] = 1;
  }
  for (int f = 0; mesh.quadratic() && f < mesh.facet_count(); ++f) {
    for (int side = 0; side < 3; ++side) {
      const bool both = in[static_cast<std::size_t>(mesh.facets(side, f))] != 0 &&
                        in[static_cast<std::size_t>(mesh.facets((side + 1) % 3, f))] != 0;
      if (both) in[static_cast<std::size_t>(mesh.facets(3 + side, f))] = 1;
    }
  }
  return in;
}

Region resolve(const RegionSettings& settings, const TetMesh& mesh) {
  const std::string where = "regions." + settings.name;
  const Inside inside = std::visit(InsideOf(), settings.shape);
  std::vector<char> in(static_cast<std::size_t>(mesh.node_count()), 0);
  if (inside) {
    for (int i = 0; i < mesh.node_count(); ++i) in[static_cast<std::size_t>(i)] = inside(mesh.nodes.col(i)) ? 1 : 0;
  } else {
    in = listed_nodes(std::get<VertexShape>(settings.shape), mesh, where);
  }
  const auto has = [&in](int node) { return in[static_cast<std::size_t>(node)] != 0; };
  Region region;
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (has(i)) region.nodes.push_back(i);
  }
  for (int f = 0; f < mesh.facet_count(); ++f) {
    if (has(mesh.facets(0, f)) && has(mesh.facets(1, f)) && has(mesh.facets(2, f))) region.facets.push_back(f);
  }
  for (int tet = 0; tet < mesh.tet_count(); ++tet) {
    const bool listed =
        has(mesh.tets(0, tet)) && has(mesh.tets(1, tet)) && has(mesh.tets(2, tet)) && has(mesh.tets(3, tet));
    if (inside ? inside(centroid(mesh, tet)) : listed) region.tets.push_back(tet);
  }
  if (region.nodes.empty() && region.tets.empty()) {
    throw InputError(where, "no node and no tetrahedron of the mesh inside", "a shape that holds part of the mesh");
  }
  return region;
}

}  // namespace

std::map<std::string, Region> resolve_regions(const std::vector<RegionSettings>& settings, const TetMesh& mesh,
                                              int times_refined) {
  if (times_refined > 0) {
    const TetMesh parent = coarsen_mesh(mesh);
    return refine_regions(resolve_regions(settings, parent, times_refined - 1), parent, mesh);
  }
  std::map<std::string, Region> regions;
  for (const RegionSettings& region : settings) {
    if (!regions.emplace(region.name, resolve(region, mesh)).second) {
      throw InputError("regions." + region.name, "the name twice", "one region a name");
    }
  }
  return regions;
}

std::map<std::string, Region> resolve_regions(const ModelSettings& settings, const TetMesh& mesh) {
  return resolve_regions(settings.regions, mesh, settings.mesh.refine);
}

}  // namespace tissue_stiffness
