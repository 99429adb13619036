#include <array>

#include "meshing/file_cursor.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {
namespace {

constexpr long long kMaxCount = 100000000;

// Positions of TetMesh's edges 01, 12, 02, 03, 13, 23 among TetGen's second-order nodes, which follow the corners.
constexpr std::array<int, 6> kTetGenEdges = {2, 3, 5, 1, 4, 0};

struct Nodes {
  Eigen::Matrix3Xd points;
  int first = 0;  // 0- or 1-based
};

Nodes read_nodes(const std::string& file) {
  FileCursor in(file);
  in.skip_comments('#');
  Nodes nodes;
  const long long count = in.integer("vertex count", 1, kMaxCount);
  in.require(count, 8, "vertices");  // four numbers and their separators
  nodes.points.resize(3, count);
  in.integer("dimension", 3, 3);
  in.line();
  for (Eigen::Index i = 0; i < nodes.points.cols(); ++i) {
    in.skip_comments('#');
    const long long lowest = i == 0 ? 0 : nodes.first + i, highest = i == 0 ? 1 : nodes.first + i;
    const auto index = static_cast<int>(in.integer("vertex number", lowest, highest));
    if (i == 0) nodes.first = index;
    for (int axis = 0; axis < 3; ++axis) nodes.points(axis, i) = in.number("coordinate");
    in.line();  // attributes and marker
  }
  return nodes;
}

}  // namespace

TetFile read_node_ele(const std::string& file) {
  const std::string stem = file.substr(0, file.rfind('.'));
  Nodes nodes = read_nodes(stem + ".node");
  FileCursor in(stem + ".ele");
  in.skip_comments('#');
  const long long count = in.integer("tetrahedron count", 1, kMaxCount);
  const long long size = in.integer("nodes a tetrahedron", 4, 10);
  if (size != 4 && size != 10) in.fail(std::to_string(size) + " nodes a tetrahedron", "4 or 10");
  in.line();
  in.require(count, 2 * (static_cast<std::size_t>(size) + 1), "tetrahedra");
  TetFile result{std::move(nodes.points), Eigen::MatrixXi(size, count)};
  for (Eigen::Index tet = 0; tet < count; ++tet) {
    in.skip_comments('#');
    in.integer("tetrahedron number", nodes.first + tet, nodes.first + tet);
    Eigen::VectorXi corners(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      corners[i] =
          static_cast<int>(in.integer("vertex number", nodes.first, nodes.first + result.nodes.cols() - 1)) - nodes.first;
    }
    in.line();  // attribute
    result.tets.col(tet).head(4) = corners.head(4);
    for (int edge = 0; size == 10 && edge < 6; ++edge) {
      result.tets(4 + edge, tet) = corners[4 + kTetGenEdges[static_cast<std::size_t>(edge)]];
    }
  }
  return result;
}

}  // namespace tissue_stiffness
