#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {

/// Tetrahedra whose nodes have numbers of their own, with gaps and in any order, as in the files of Gmsh and Abaqus.
class NumberedTets {
 public:
  /// Adds a node at a point in the file's unit. Returns false for a number that is there already.
  bool add_node(long long number, const Eigen::Vector3d& point);

  /// Node numbers of the tetrahedra in the node order of TetMesh, 4 or 10 each.
  std::vector<long long> linear, quadratic;

  bool complete() const { return !points_.empty() && linear.size() + quadratic.size() > 0; }

  /// Returns the mesh. With tetrahedra of both orders, all have 4 nodes. Nodes that no tetrahedron has are left out,
  /// because programs write construction points. The others keep the order in which they were added. `refuse` is called
  /// with a node's number that no node has, and throws.
  TetFile assemble(const std::function<void(long long number)>& refuse) const;

 private:
  std::vector<Eigen::Vector3d> points_;
  std::unordered_map<long long, std::size_t> place_;
};

}  // namespace tissue_stiffness
