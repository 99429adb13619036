#include "meshing/refine.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "meshing/elevate.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

// Mid nodes at the ends of the inner octahedron's three diagonals, each followed by the ring of four around it.
constexpr std::array<std::array<int, 6>, 3> kDiagonals = {{{4, 9, 5, 6, 7, 8}, {5, 7, 4, 6, 9, 8}, {6, 8, 4, 5, 9, 7}}};

/// Returns the quadratic shape functions at barycentric coordinates (l0..l3), in the node order of TetMesh.
Eigen::Matrix<double, 10, 1> quadratic_shape(const Eigen::Vector4d& l) {
  Eigen::Matrix<double, 10, 1> shape;
  for (int i = 0; i < 4; ++i) shape[i] = l[i] * (2.0 * l[i] - 1.0);
  for (int e = 0; e < 6; ++e) shape[4 + e] = 4.0 * l[kTetEdges[e][0]] * l[kTetEdges[e][1]];
  return shape;
}

/// Returns the barycentric coordinates of the ten nodes.
Eigen::Matrix<double, 4, 10> node_coordinates() {
  Eigen::Matrix<double, 4, 10> out = Eigen::Matrix<double, 4, 10>::Zero();
  for (int i = 0; i < 4; ++i) out(i, i) = 1.0;
  for (int e = 0; e < 6; ++e) out(kTetEdges[e][0], 4 + e) = out(kTetEdges[e][1], 4 + e) = 0.5;
  return out;
}

void orient(std::array<int, 4>& tet, const Eigen::Matrix<double, 3, 10>& x) {
  const Eigen::Vector3d a = x.col(tet[1]) - x.col(tet[0]), b = x.col(tet[2]) - x.col(tet[0]),
                        c = x.col(tet[3]) - x.col(tet[0]);
  if (a.cross(b).dot(c) < 0.0) std::swap(tet[2], tet[3]);
}

/// Returns the eight children in local numbers.
std::array<std::array<int, 4>, 8> children(const Eigen::Matrix<double, 3, 10>& x) {
  std::array<std::array<int, 4>, 8> out = {{{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}}};
  const auto length = [&x](const std::array<int, 6>& d) { return (x.col(d[0]) - x.col(d[1])).squaredNorm(); };
  const auto& diagonal = *std::min_element(kDiagonals.begin(), kDiagonals.end(),
                                           [&](const auto& a, const auto& b) { return length(a) < length(b); });
  for (std::size_t i = 0; i < 4; ++i) {
    out[4 + i] = {diagonal[0], diagonal[1], diagonal[2 + i], diagonal[2 + (i + 1) % 4]};
  }
  for (auto& tet : out) orient(tet, x);
  return out;
}

/// A 10-node mesh's children, and the positions of their mid-edge nodes on the parent's quadratic geometry.
struct Children {
  std::vector<std::array<int, 4>> tets;
  std::map<std::pair<int, int>, Eigen::Vector3d> middles;
};

Children cut(const TetMesh& mesh) {
  static const Eigen::Matrix<double, 4, 10> coordinates = node_coordinates();
  Children out;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    Eigen::Matrix<double, 3, 10> x;
    for (int i = 0; i < 10; ++i) x.col(i) = mesh.nodes.col(mesh.tets(i, t));
    for (const auto& child : children(x)) {
      std::array<int, 4> nodes;
      for (std::size_t i = 0; i < 4; ++i) nodes[i] = mesh.tets(child[i], t);
      out.tets.push_back(nodes);
      for (const auto& edge : kTetEdges) {
        const int a = child[static_cast<std::size_t>(edge[0])], b = child[static_cast<std::size_t>(edge[1])];
        const std::pair<int, int> key = std::minmax(mesh.tets(a, t), mesh.tets(b, t));
        if (out.middles.count(key) > 0) continue;
        out.middles[key] = x * quadratic_shape(0.5 * (coordinates.col(a) + coordinates.col(b)));
      }
    }
  }
  return out;
}

}  // namespace

TetMesh refine_mesh(const TetMesh& mesh) {
  TetMesh parent = mesh;
  elevate_to_quadratic(parent);
  const Children cuts = cut(parent);
  TetMesh fine;
  fine.nodes = parent.nodes;
  fine.corner_count = parent.node_count();
  fine.tets.resize(4, static_cast<Eigen::Index>(cuts.tets.size()));
  for (std::size_t t = 0; t < cuts.tets.size(); ++t) {
    for (int i = 0; i < 4; ++i) fine.tets(i, static_cast<Eigen::Index>(t)) = cuts.tets[t][static_cast<std::size_t>(i)];
  }
  if (mesh.quadratic()) {
    elevate_to_quadratic(fine);
    for (int t = 0; t < fine.tet_count(); ++t) {
      for (int e = 0; e < 6; ++e) {
        const std::pair<int, int> key = std::minmax(fine.tets(kTetEdges[e][0], t), fine.tets(kTetEdges[e][1], t));
        fine.nodes.col(fine.tets(4 + e, t)) = cuts.middles.at(key);
      }
    }
  }
  set_boundary_facets(fine, "refined mesh");
  return fine;
}

namespace {

using Triple = std::array<int, 3>;

Triple sorted(Triple triple) {
  std::sort(triple.begin(), triple.end());
  return triple;
}

std::set<Triple> children_of_facets(const TetMesh& parent, const std::vector<int>& facets) {
  std::set<Triple> out;
  for (const int f : facets) {
    const auto n = [&](int i) { return parent.facets(i, f); };
    for (const Triple& child :
         {Triple{n(0), n(3), n(5)}, Triple{n(3), n(1), n(4)}, Triple{n(5), n(4), n(2)}, Triple{n(3), n(4), n(5)}}) {
      out.insert(sorted(child));
    }
  }
  return out;
}

// A mid-edge node is inside when both ends of its edge are.
void add_middles(const TetMesh& mesh, std::vector<char>& inside) {
  for (int t = 0; mesh.quadratic() && t < mesh.tet_count(); ++t) {
    for (int e = 0; e < 6; ++e) {
      const auto in = [&](int local) { return inside[static_cast<std::size_t>(mesh.tets(local, t))] != 0; };
      const auto middle = static_cast<std::size_t>(mesh.tets(4 + e, t));
      if (in(kTetEdges[e][0]) && in(kTetEdges[e][1])) inside[middle] = 1;
    }
  }
}

Region refine_region(const Region& region, const TetMesh& mesh, const TetMesh& parent, const TetMesh& refined) {
  Region out;
  std::vector<char> inside(static_cast<std::size_t>(std::max(parent.node_count(), refined.node_count())), 0);
  for (const int node : region.nodes) inside[static_cast<std::size_t>(node)] = 1;
  if (!mesh.quadratic()) add_middles(parent, inside);
  add_middles(refined, inside);
  for (int node = 0; node < refined.node_count(); ++node) {
    if (inside[static_cast<std::size_t>(node)] != 0) out.nodes.push_back(node);
  }
  const std::set<Triple> facets = children_of_facets(parent, region.facets);
  for (int f = 0; f < refined.facet_count(); ++f) {
    const Triple corners{refined.facets(0, f), refined.facets(1, f), refined.facets(2, f)};
    if (facets.count(sorted(corners)) == 1) out.facets.push_back(f);
  }
  for (const int tet : region.tets) {
    for (int child = 0; child < 8; ++child) out.tets.push_back(8 * tet + child);
  }
  return out;
}

}  // namespace

std::map<std::string, Region> refine_regions(const std::map<std::string, Region>& regions, const TetMesh& mesh,
                                             const TetMesh& refined) {
  TetMesh parent = mesh;
  elevate_to_quadratic(parent);
  std::map<std::string, Region> out;
  for (const auto& [name, region] : regions) out[name] = refine_region(region, mesh, parent, refined);
  return out;
}

namespace {

int place_of(int node, const TetMesh& mesh, int tet) {
  const auto nodes = mesh.tets.col(tet);
  return static_cast<int>(std::find(nodes.data(), nodes.data() + nodes.size(), node) - nodes.data());
}

}  // namespace

Prolongation prolongation(const TetMesh& mesh, const TetMesh& refined) {
  static const Eigen::Matrix<double, 4, 10> coordinates = node_coordinates();
  std::vector<Eigen::Triplet<double>> shares;
  std::vector<char> done(static_cast<std::size_t>(refined.node_count()), 0);
  for (int node = 0; node < mesh.node_count(); ++node) {
    shares.emplace_back(node, node, 1.0);
    done[static_cast<std::size_t>(node)] = 1;
  }
  const auto add = [&](int node, int parent, const Eigen::Vector4d& at) {
    if (std::exchange(done[static_cast<std::size_t>(node)], 1) != 0) return;
    const Eigen::VectorXd shape = mesh.quadratic() ? Eigen::VectorXd(quadratic_shape(at)) : Eigen::VectorXd(at);
    for (int i = 0; i < mesh.tets.rows(); ++i) {
      if (shape[i] != 0.0) shares.emplace_back(node, mesh.tets(i, parent), shape[i]);
    }
  };
  TetMesh parents = mesh;
  elevate_to_quadratic(parents);
  for (int t = 0; t < refined.tet_count(); ++t) {
    const auto at = [&](int corner) { return coordinates.col(place_of(refined.tets(corner, t), parents, t / 8)); };
    for (int i = 0; i < 4; ++i) add(refined.tets(i, t), t / 8, at(i));
    for (int e = 0; refined.quadratic() && e < 6; ++e) {
      add(refined.tets(4 + e, t), t / 8, 0.5 * (at(kTetEdges[e][0]) + at(kTetEdges[e][1])));
    }
  }
  Prolongation out(refined.node_count(), mesh.node_count());
  out.setFromTriplets(shares.begin(), shares.end());
  return out;
}

}  // namespace tissue_stiffness
