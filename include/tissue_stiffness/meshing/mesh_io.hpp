#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Tetrahedra as they are in a file: 4 or 10 rows, in the node order of TetMesh, with nodes numbered from 0.
struct TetFile {
  Eigen::Matrix3Xd nodes;  ///< in the file's unit
  Eigen::MatrixXi tets;
};

/// Reads a legacy VTK unstructured grid (versions 2 to 5.1, ASCII or binary) with cell types 10 and 24. Cells of lower
/// dimension are skipped, other solids are refused. A grid with both types is read as 4-node.
TetFile read_vtk(const std::string& file);

/// Reads TetGen's FILE.node and FILE.ele, either of which may be named. Nodes are numbered from 0 or 1; tetrahedra have 4
/// or 10 nodes.
TetFile read_node_ele(const std::string& file);

/// Reads Gmsh 2.2 or 4.1, ASCII, with element types 4 and 11. Lower dimensions are skipped, other solids are refused.
TetFile read_msh(const std::string& file);

/// Reads an input file of Abaqus or CalculiX: *NODE, and *ELEMENT of the types C3D4 and C3D10 (C3D10M and the like, too).
/// Elements of lower dimension are skipped, other solids are refused. So are keywords that make or move nodes or
/// elements, a second part or instance, and data in another file. All other keywords are skipped with their data: sets,
/// materials, steps.
TetFile read_inp(const std::string& file);

/// Reads tetrahedra from a file. Throws InputError, naming the file and the place.
using TetReader = std::function<TetFile(const std::string& file)>;

/// Lets load_tet_mesh read files of a further ending, in lower case with its dot, such as ".abc".
void add_tet_reader(const std::string& ending, const TetReader& reader);

/// Returns the mesh of a tetrahedral file (by its ending: .vtk, .node, .ele, .msh, .inp, or one that was added), with
/// coordinates times `scale` [m per file unit]. Corner nodes come first, in the file's order. The mid-edge nodes follow;
/// they are the file's own when it has them. When every tetrahedron is inverted, the file has the opposite node order and
/// is reordered. Order 1 drops mid-edge nodes. Throws InputError, naming file and place, for NaN, coincident or unused
/// vertices, single inverted or flat tetrahedra, and faces with more than two tetrahedra.
TetMesh load_tet_mesh(const std::string& file, double scale, int order);

/// Returns whether load_tet_mesh knows the file's ending.
bool is_tet_file(const std::string& file);

/// Returns these endings for messages: ".ele, .msh, ...".
std::string tet_endings();

/// Writes a legacy ASCII .vtk (types 10 or 24) that load_tet_mesh reads back exactly. Throws InputError when the file
/// cannot be written or does not end in .vtk.
void save_mesh(const TetMesh& mesh, const std::string& file);

}  // namespace tissue_stiffness
