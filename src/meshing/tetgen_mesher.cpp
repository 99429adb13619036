// The only file that touches TetGen, whose licence is the AGPL. Without it surfaces are refused with a message that says
// so.
#include "tissue_stiffness/meshing/tetgen_mesher.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <vector>

#include "tissue_stiffness/meshing/file_cursor.hpp"
#include "tissue_stiffness/meshing/run_apart.hpp"
#include "tissue_stiffness/types/error.hpp"

#ifdef TISSUE_STIFFNESS_TETGEN
#define TETLIBRARY
#include <tetgen.h>
#endif

namespace tissue_stiffness {

#ifdef TISSUE_STIFFNESS_TETGEN
namespace {

// Vertices off a plane by less than this share of the body's size are rounding of 32-bit coordinates.
constexpr double kPlaneShare = 2e-6;
constexpr unsigned kMaxSeconds = 600;

// tetgenio frees these arrays itself.
template <typename T>
T* new_array(std::size_t count) {
  return new T[count];
}

void set_facets(const PlanarFacets& plc, double unit, tetgenio& in) {
  in.firstnumber = 0;
  in.numberofpoints = static_cast<int>(plc.vertices.cols());
  in.pointlist = new_array<REAL>(static_cast<std::size_t>(plc.vertices.size()));
  Eigen::Map<Eigen::Matrix3Xd>(in.pointlist, 3, plc.vertices.cols()) = plc.vertices / unit;
  in.numberoffacets = static_cast<int>(plc.facets.size());
  in.facetlist = new_array<tetgenio::facet>(plc.facets.size());
  for (std::size_t f = 0; f < plc.facets.size(); ++f) {
    const PlanarFacets::Facet& from = plc.facets[f];
    tetgenio::facet& to = in.facetlist[f];
    tetgenio::init(&to);
    to.numberofpolygons = static_cast<int>(from.loops.size());
    to.polygonlist = new_array<tetgenio::polygon>(from.loops.size());
    for (std::size_t p = 0; p < from.loops.size(); ++p) {
      to.polygonlist[p].numberofvertices = static_cast<int>(from.loops[p].size());
      to.polygonlist[p].vertexlist = new_array<int>(from.loops[p].size());
      std::copy(from.loops[p].begin(), from.loops[p].end(), to.polygonlist[p].vertexlist);
    }
    to.numberofholes = static_cast<int>(from.hole_points.size());
    to.holelist = from.hole_points.empty() ? nullptr : new_array<REAL>(3 * from.hole_points.size());
    for (std::size_t h = 0; h < from.hole_points.size(); ++h) {
      Eigen::Map<Eigen::Vector3d>(to.holelist + 3 * h) = from.hole_points[h] / unit;
    }
  }
}

void run(std::string switches, tetgenio& in, tetgenio& out) {
  tetgenbehavior behavior;
  if (!behavior.parse_commandline(&switches[0])) throw NumericalError("TetGen does not know its switches");
  tetrahedralize(&behavior, &in, &out);
}

// TetGen lists the facets that cross others.
void refuse_crossings(const TriangleSurface& surface, double unit, const std::string& where) {
  tetgenio in, out;
  set_facets(triangles_as_facets(surface), unit, in);
  run("pdQ", in, out);
  if (out.numberoftrifaces == 0) return;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    centre += Eigen::Map<const Eigen::Vector3d>(out.pointlist + 3 * out.trifacelist[i]) * (unit / 3.0);
  }
  throw InputError(where, "a surface that crosses itself near " + format_point(centre),
                   "triangles that meet at common edges only");
}

// Radius-edge ratio 1.6 and dihedral angles above 15 degrees where the surface lets them. A volume limit of twice a regular
// tetrahedron's makes the mean edge 0.94 of the length asked for.
std::string switches(double edge, bool keep_triangles) {
  std::ostringstream text;
  text << "pq1.6/15AQ";
  if (edge > 0.0) text << "a" << 2.0 * edge * edge * edge / (6.0 * std::sqrt(2.0));
  if (keep_triangles) text << "Y";
  return text.str();
}

// Tetrahedra of the regions that an odd number of shells encloses, and the points that they use.
TetFile keep_body(const tetgenio& out, double unit, const TriangleSurface& surface, const std::string& where) {
  if (out.numberoftetrahedra == 0) throw InputError(where, "a surface without inside", "a closed surface");
  const Eigen::Map<const Eigen::MatrixXi> tets(out.tetrahedronlist, out.numberofcorners, out.numberoftetrahedra);
  const Eigen::Map<const Eigen::Matrix3Xd> points(out.pointlist, 3, out.numberofpoints);
  std::vector<double> regions;
  std::vector<bool> solid;
  std::vector<int> number(static_cast<std::size_t>(points.cols()), -1);
  TetFile result{Eigen::Matrix3Xd(3, points.cols()), Eigen::MatrixXi(4, tets.cols())};
  Eigen::Index tet_count = 0;
  int point_count = 0;
  for (Eigen::Index t = 0; t < tets.cols(); ++t) {
    const double region = out.tetrahedronattributelist[t * out.numberoftetrahedronattributes];
    auto known = static_cast<std::size_t>(std::find(regions.begin(), regions.end(), region) - regions.begin());
    if (known == regions.size()) {
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (int i = 0; i < 4; ++i) centre += 0.25 * unit * points.col(tets(i, t));
      regions.push_back(region);
      solid.push_back(std::lround(winding_number(surface, centre)) % 2 != 0);
    }
    if (!solid[known]) continue;
    for (int i = 0; i < 4; ++i) {
      int& to = number[static_cast<std::size_t>(tets(i, t))];
      if (to < 0) {
        to = point_count++;
        result.nodes.col(to) = unit * points.col(tets(i, t));
      }
      result.tets(i, tet_count) = to;
    }
    ++tet_count;
  }
  result.nodes.conservativeResize(3, point_count);
  result.tets.conservativeResize(4, tet_count);
  return result;
}

TetFile fill(const TriangleSurface& surface, double max_edge_length, bool keep_triangles, const std::string& where) {
  const double size = (surface.vertices.rowwise().maxCoeff() - surface.vertices.rowwise().minCoeff()).norm();
  refuse_crossings(surface, size, where);
  const bool keep = keep_triangles || max_edge_length <= 0.0;
  PlanarFacets plc = keep ? triangles_as_facets(surface) : merge_coplanar(surface, kPlaneShare * size);
  if (!keep) subdivide_edges(plc, max_edge_length);
  tetgenio in, out;
  set_facets(plc, size, in);  // TetGen's tolerances and number formats suit bodies of unit size
  run(switches(max_edge_length / size, keep), in, out);
  return keep_body(out, size, surface, where);
}

template <typename Matrix>
void append(std::string& bytes, const Matrix& matrix) {
  const std::int64_t columns = matrix.cols();
  bytes.append(reinterpret_cast<const char*>(&columns), sizeof(columns));
  bytes.append(reinterpret_cast<const char*>(matrix.data()),
               sizeof(typename Matrix::Scalar) * static_cast<std::size_t>(matrix.size()));
}

template <typename Matrix>
std::size_t extract(const std::string& bytes, std::size_t at, Eigen::Index rows, Matrix& matrix) {
  std::int64_t columns = 0;
  std::memcpy(&columns, bytes.data() + at, sizeof(columns));
  matrix.resize(rows, columns);
  const std::size_t size = sizeof(typename Matrix::Scalar) * static_cast<std::size_t>(matrix.size());
  std::memcpy(matrix.data(), bytes.data() + at + sizeof(columns), size);
  return at + sizeof(columns) + size;
}

std::string to_bytes(const TetFile& mesh) {
  std::string bytes;
  append(bytes, mesh.nodes);
  append(bytes, mesh.tets);
  return bytes;
}

TetFile from_bytes(const std::string& bytes, std::size_t at) {
  TetFile mesh;
  extract(bytes, extract(bytes, at, 3, mesh.nodes), 4, mesh.tets);
  return mesh;
}

std::string mesh_or_message(const TriangleSurface& surface, double edge, bool keep, const std::string& where) {
  try {
    return 'M' + to_bytes(fill(surface, edge, keep, where));
  } catch (const InputError& error) {
    return std::string("E") + error.what();
  }
}

}  // namespace

// Apart, because TetGen 1.5's library frees its memory twice when it gives up.
TetFile fill_surface(const TriangleSurface& surface, double max_edge_length, bool keep_triangles,
                     const std::string& where) {
  const auto result =
      run_apart([&] { return mesh_or_message(surface, max_edge_length, keep_triangles, where); }, kMaxSeconds);
  if (!result || result->empty()) {
    throw InputError(where, "a surface on which TetGen gives up",
                     "a closed surface without needle triangles or parts that nearly touch");
  }
  if (result->front() == 'E') throw InputError(result->substr(1));
  return from_bytes(*result, 1);
}

#else

TetFile fill_surface(const TriangleSurface&, double, bool, const std::string& where) {
  throw InputError(where, "a surface, but this build is without TetGen",
                   "tetrahedra (.vtk, .node/.ele, .msh), or a build with -DTISSUE_STIFFNESS_TETGEN=ON");
}

#endif

}  // namespace tissue_stiffness
