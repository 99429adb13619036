// This is the only file that uses TetGen, whose licence is the AGPL. Without TetGen surfaces are refused with a message
// that says so.
#include "meshing/tetgen_mesher.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "meshing/file_cursor.hpp"
#include "meshing/planar_facets.hpp"
#include "meshing/tets_apart.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/body_size.hpp"

#ifdef TISSUE_STIFFNESS_TETGEN
#define TETLIBRARY
#include <tetgen.h>
#endif

namespace tissue_stiffness {

#ifdef TISSUE_STIFFNESS_TETGEN
namespace {

// Vertices that are off a plane by less than this share of the body's size are rounded 32-bit coordinates.
constexpr double kPlaneShare = 2e-6;
constexpr double kNeedleShare = 1e-9;  // area over the longest side squared
constexpr unsigned kMaxSeconds = 120;

// tetgenio frees these arrays itself.
template <typename T>
T* new_array(std::size_t count) {
  return new T[count];
}

void set_facets(const TriangleSurface& surface, double unit, tetgenio& in) {
  in.firstnumber = 0;
  in.numberofpoints = surface.vertex_count();
  in.pointlist = new_array<REAL>(static_cast<std::size_t>(surface.vertices.size()));
  Eigen::Map<Eigen::Matrix3Xd>(in.pointlist, 3, surface.vertices.cols()) = surface.vertices / unit;
  in.numberoffacets = surface.triangle_count();
  in.facetlist = new_array<tetgenio::facet>(static_cast<std::size_t>(surface.triangle_count()));
  for (int t = 0; t < surface.triangle_count(); ++t) {
    tetgenio::facet& facet = in.facetlist[t];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new_array<tetgenio::polygon>(1);
    facet.polygonlist[0].numberofvertices = 3;
    facet.polygonlist[0].vertexlist = new_array<int>(3);
    Eigen::Map<Eigen::Vector3i>(facet.polygonlist[0].vertexlist) = surface.triangles.col(t);
  }
}

void run(std::string switches, tetgenio& in, tetgenio& out) {
  tetgenbehavior behavior;
  if (!behavior.parse_commandline(&switches[0])) throw NumericalError("TetGen does not know its switches");
  tetrahedralize(&behavior, &in, &out);
}

// TetGen's search for crossings does not terminate for triangles without area.
void refuse_needles(const TriangleSurface& surface, const std::string& where) {
  for (int t = 0; t < surface.triangle_count(); ++t) {
    Eigen::Matrix3d x;
    for (int i = 0; i < 3; ++i) x.col(i) = surface.vertices.col(surface.triangles(i, t));
    const double longest =
        std::max({(x.col(1) - x.col(0)).norm(), (x.col(2) - x.col(1)).norm(), (x.col(0) - x.col(2)).norm()});
    if (triangle_area_vector(surface, t).norm() > kNeedleShare * longest * longest) continue;
    throw InputError(where, "a triangle without area at " + format_point(x.rowwise().mean()),
                     "triangles with an area, or a max_edge_length, which cuts plane parts anew");
  }
}

// TetGen lists the facets that cross others.
void refuse_crossings(const TriangleSurface& surface, double unit, const std::string& where) {
  tetgenio in, out;
  set_facets(surface, unit, in);
  run("pdQ", in, out);
  if (out.numberoftrifaces == 0) return;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    centre += Eigen::Map<const Eigen::Vector3d>(out.pointlist + 3 * out.trifacelist[i]) * (unit / 3.0);
  }
  throw InputError(where, "a surface that crosses itself near " + format_point(centre),
                   "triangles that meet at common edges only");
}

// The radius-edge ratio is 1.6, and dihedral angles are above 15 degrees where the surface allows it. The volume limit is
// twice a regular tetrahedron's, which makes the mean edge 0.94 of the requested length.
std::string switches(double edge, bool keep_triangles) {
  std::ostringstream text;
  text << "pq1.6/15AQ";
  if (edge > 0.0) text << "a" << 2.0 * edge * edge * edge / (6.0 * std::sqrt(2.0));
  if (keep_triangles) text << "Y";
  return text.str();
}

// Keeps the tetrahedra of the regions that an odd number of shells encloses, and the points that they use.
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

TriangleSurface coarsened(const TriangleSurface& surface, double tolerance, double edge_length) {
  PlanarFacets facets = merge_coplanar(surface, tolerance);
  subdivide_edges(facets, edge_length);
  return triangulate(facets);
}

TetFile fill(const TriangleSurface& surface, double max_edge_length, bool keep_triangles, const std::string& where) {
  const double size = body_size(surface.vertices);
  const bool keep = keep_triangles || max_edge_length <= 0.0;
  const TriangleSurface skin = keep ? surface : coarsened(surface, kPlaneShare * size, max_edge_length);
  refuse_needles(skin, where);
  refuse_crossings(skin, size, where);
  tetgenio in, out;
  set_facets(skin, size, in);  // TetGen's tolerances and number formats suit bodies of unit size
  run(switches(max_edge_length / size, keep), in, out);
  return keep_body(out, size, surface, where);
}

}  // namespace

bool has_tetgen() {
  return true;
}

// TetGen runs in another process, because the library of TetGen 1.5 frees its memory twice when it gives up.
TetFile fill_surface(const TriangleSurface& surface, double max_edge_length, bool keep_triangles, const std::string& where,
                     const std::function<void()>& checkpoint) {
  auto mesh =
      make_tets_apart([&] { return fill(surface, max_edge_length, keep_triangles, where); }, kMaxSeconds, checkpoint);
  if (mesh) return *std::move(mesh);
  throw InputError(where, "a surface on which TetGen gives up",
                   "a closed surface without needle triangles or parts that nearly touch");
}

#else

bool has_tetgen() {
  return false;
}

TetFile fill_surface(const TriangleSurface&, double, bool, const std::string& where, const std::function<void()>&) {
  throw InputError(where, "a surface, but this build is without TetGen",
                   "tetrahedra (" + tet_endings() + "), or a build with -DTISSUE_STIFFNESS_TETGEN=ON");
}

#endif

}  // namespace tissue_stiffness
