#include <limits>

#include "tissue_stiffness/settings/key_spec.hpp"

namespace tissue_stiffness {
namespace {

using Kind = KeySpec::Kind;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPositive = std::numeric_limits<double>::min();

KeySpec required(const std::string& path, Kind kind, const std::string& unit, const std::string& meaning) {
  return {path, kind, unit, 0, 0, {}, true, 0, "", meaning};
}
KeySpec positive(const std::string& path, const std::string& unit, const std::string& meaning) {
  return {path, Kind::number, unit, kPositive, kInfinity, {}, true, 0, "", meaning};
}
/// A number that may be left out, and is `value` then.
KeySpec number(const std::string& path, const std::string& unit, double lower, double value, const std::string& meaning) {
  return {path, Kind::number, unit, lower, kInfinity, {}, false, value, "", meaning};
}
KeySpec optional(const std::string& path, Kind kind, const std::string& unit, const std::string& meaning) {
  return {path, kind, unit, 0, 0, {}, false, 0, "", meaning};
}
KeySpec choice(const std::string& path, const std::vector<std::string>& choices, bool needed, const std::string& meaning) {
  return {path, Kind::choice, "", 0, 0, choices, needed, 0, "", meaning};
}

std::vector<KeySpec> mesh_keys() {
  const std::string edge = "longest edge that a new mesh may have; 0: as the surface is";
  return {
      required("mesh", Kind::map, "", "the body at rest: one of `file`, `revolve`, `extrude`, and the keys beside it"),
      optional("mesh.file", Kind::text, "",
               "tetrahedra (.vtk, .msh, .node beside .ele) or a closed surface (.stl, .ply, .obj), from the model "
               "file's folder"),
      number("mesh.scale", "", kPositive, 1, "metres a unit of the file"),
      number("mesh.max_edge_length", "m", kPositive, 0, edge),
      optional("mesh.revolve", Kind::map, "",
               "the body that the first contour makes, turned about an axis through its middle"),
      choice("mesh.revolve.contour", {"first"}, true, "which one"),
      required("mesh.revolve.axis", Kind::numbers, "", "direction of the axis [x, y, z] in the model frame"),
      number("mesh.revolve.max_edge_length", "m", kPositive, 0, edge),
      optional("mesh.extrude", Kind::map, "", "the body that the first contour makes, drawn along the viewing direction"),
      choice("mesh.extrude.contour", {"first"}, true, "which one"),
      positive("mesh.extrude.depth", "m", "thickness"),
      number("mesh.extrude.max_edge_length", "m", kPositive, 0, edge),
      {"mesh.order", Kind::integer, "", 1, 2, {}, false, 2, "", "2: 10-node tetrahedra; 1: 4-node, which are too stiff"},
      {"mesh.discretisation_error",
       Kind::boolean,
       "",
       0,
       1,
       {},
       false,
       1,
       "",
       "find out what the mesh does to the estimate, correct it, widen the interval"},
  };
}

std::vector<KeySpec> region_keys() {
  const auto point = [](const std::string& path, const std::string& meaning) {
    return required(path, Kind::numbers, "m", meaning);
  };
  return {
      optional("regions", Kind::map, "", "named sets of rest vertices and facets, one shape each"),
      optional("regions.*.box", Kind::map, "", "between two corners"),
      point("regions.*.box.min", "[x, y, z]"),
      point("regions.*.box.max", "[x, y, z]"),
      optional("regions.*.sphere", Kind::map, "", "about a centre"),
      point("regions.*.sphere.center", "[x, y, z]"),
      positive("regions.*.sphere.radius", "m", "radius"),
      optional("regions.*.ellipsoid", Kind::map, "", "about a centre, along the axes"),
      point("regions.*.ellipsoid.center", "[x, y, z]"),
      point("regions.*.ellipsoid.radii", "three, > 0"),
      optional("regions.*.half_space", Kind::map, "", "behind a plane"),
      point("regions.*.half_space.point", "on the plane [x, y, z]"),
      required("regions.*.half_space.normal", Kind::numbers, "", "away from the region [x, y, z]"),
      optional("regions.*.vertices", Kind::list, "", "vertex numbers of the mesh"),
  };
}

std::vector<KeySpec> observation_keys() {
  std::vector<KeySpec> keys{required("observations", Kind::list, "", "what is measured, one sensor an entry")};
  for (const char* kind : {"vertices", "markers", "points"}) {
    const std::string path = std::string("observations[].") + kind;
    const std::string cloud = "sensor_msgs/PointCloud2";
    const std::string what = kind[0] == 'v'   ? cloud + " with a field `vertex`, the mesh vertex of each point"
                             : kind[0] == 'm' ? cloud + " with a field `marker`, the row of `rest` of each point"
                                              : cloud + " of the surface; no point has a name";
    keys.push_back(optional(path, Kind::map, "", what));
    keys.push_back(required(path + ".topic", Kind::text, "", "of the cloud"));
    keys.push_back(positive(path + ".noise", "m", "1 sigma of a coordinate"));
    if (kind[0] == 'm') {
      keys.push_back(required(path + ".rest", Kind::list, "m", "where the markers are at rest, [x, y, z] each"));
    }
  }
  const std::string contour = "observations[].contour";
  keys.insert(
      keys.end(),
      {optional(contour, Kind::map, "", "outline in images; the sensor's pose comes from tf"),
       required(contour + ".image", Kind::text, "", "topic of the images, sensor_msgs/Image"),
       required(contour + ".camera_info", Kind::text, "",
                "topic of the calibration, sensor_msgs/CameraInfo; for a slice fx and fy are pixels a metre"),
       positive(contour + ".noise", "m", "1 sigma along the outline's normal"),
       optional(contour + ".segmentation", Kind::map, "", "how the outline is found"),
       choice(contour + ".segmentation.kind", {"silhouette", "cavity"}, true,
              "the body against a darker background, or a dark pool inside a bright wall (B-mode)"),
       optional(contour + ".segmentation.seed", Kind::numbers, "pixel",
                "[u, v] inside the body or the pool; found when absent"),
       choice(contour + ".projection", {"silhouette", "slice"}, false,
              "the outline that a pinhole sees, or the surface cut by the image plane"),
       optional(contour + ".region", Kind::text, "", "part of the surface that the outline belongs to; all when absent")});
  return keys;
}

std::vector<KeySpec> run_keys() {
  return {
      optional("time", Kind::map, "", "of the run"),
      number("time.start", "s", -kInfinity, 0, "when the body was at rest, undeformed, after the recording's first stamp"),
      number("time.step", "s", kPositive, 0, "of the integration; 0: chosen"),
      optional("initial", Kind::map, "", "the body's motion at the start; without it, rest"),
      required("initial.velocity", Kind::numbers, "m/s", "[x, y, z] of the whole body, or `from_frames`"),
      choice("estimator", {"unscented", "paper"}, false,
             "the default, or the scheme of Yang & Lin 2016 as it was published, to compare with"),
  };
}

}  // namespace

const std::vector<KeySpec>& model_keys() {
  static const std::vector<KeySpec> keys = [] {
    std::vector<KeySpec> all = mesh_keys();
    const auto append = [&](const std::vector<KeySpec>& more) { all.insert(all.end(), more.begin(), more.end()); };
    append(region_keys());
    append({required("effects", Kind::list, "",
                     "what the model is made of, one effect an entry; their keys are in effects.md")});
    append(observation_keys());
    append(run_keys());
    return all;
  }();
  return keys;
}

}  // namespace tissue_stiffness
