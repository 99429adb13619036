#include <limits>

#include "settings/key_spec.hpp"

namespace tissue_stiffness {
namespace {

using Kind = KeySpec::Kind;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPositive = std::numeric_limits<double>::min();
constexpr double kLeastFactor = 1.01;

KeySpec positive(const std::string& path, const std::string& unit, const std::string& meaning) {
  return required_number(path, unit, kPositive, kInfinity, meaning);
}

std::vector<KeySpec> mesh_keys() {
  const std::string edge = "longest edge that a new mesh may have; 0: as the surface is";
  return {
      required_key("mesh", Kind::map, "", "the body at rest: one of `file`, `revolve`, `extrude`, and the keys beside it"),
      plain_key("mesh.file", Kind::text, "",
                "tetrahedra (.vtk, .vtu, .msh, .inp, .node beside .ele) or a closed surface (.stl, .ply, .obj), from the "
                "model file's folder"),
      number_key("mesh.scale", "", kPositive, kInfinity, 1, "metres a unit of the file"),
      number_key("mesh.scale_tolerance", "", 0, 1, 0.005, "by which every length of the mesh may be off, 1 sigma"),
      number_key("mesh.surface_tolerance", "m", 0, kInfinity, 0.0,
                 "by which the whole surface may lie too far out or in, 1 sigma"),
      number_key("mesh.max_edge_length", "m", kPositive, kInfinity, 0, edge),
      plain_key("mesh.revolve", Kind::map, "",
                "the body that the first contour makes, turned about an axis through its middle"),
      choice_key("mesh.revolve.contour", {"first"}, true, "which one"),
      required_key("mesh.revolve.axis", Kind::numbers, "", "direction of the axis [x, y, z] in the model frame"),
      number_key("mesh.revolve.max_edge_length", "m", kPositive, kInfinity, 0, edge),
      plain_key("mesh.extrude", Kind::map, "", "the body that the first contour makes, drawn along the viewing direction"),
      choice_key("mesh.extrude.contour", {"first"}, true, "which one"),
      positive("mesh.extrude.depth", "m", "thickness"),
      number_key("mesh.extrude.max_edge_length", "m", kPositive, kInfinity, 0, edge),
      integer_key("mesh.order", 1, 2, 2, "2: 10-node tetrahedra; 1: 4-node, which are too stiff"),
      integer_key("mesh.refine", 0, 2, 0, "number of times that every tetrahedron is cut into eight"),
      choice_key("mesh.boundary", {"smooth", "faceted"}, false,
                 "whether facets that meet at a blunt angle stand for a smooth surface, or are the body's own"),
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
    return required_key(path, Kind::numbers, "m", meaning);
  };
  return {
      plain_key("regions", Kind::map, "", "named sets of rest vertices and facets, one shape each"),
      plain_key("regions.*.box", Kind::map, "", "between two corners"),
      point("regions.*.box.min", "[x, y, z]"),
      point("regions.*.box.max", "[x, y, z]"),
      plain_key("regions.*.sphere", Kind::map, "", "about a centre"),
      point("regions.*.sphere.center", "[x, y, z]"),
      positive("regions.*.sphere.radius", "m", "radius"),
      plain_key("regions.*.ellipsoid", Kind::map, "", "about a centre, along the axes"),
      point("regions.*.ellipsoid.center", "[x, y, z]"),
      point("regions.*.ellipsoid.radii", "three, > 0"),
      plain_key("regions.*.half_space", Kind::map, "", "behind a plane"),
      point("regions.*.half_space.point", "on the plane [x, y, z]"),
      required_key("regions.*.half_space.normal", Kind::numbers, "", "away from the region [x, y, z]"),
      plain_key("regions.*.vertices", Kind::list, "", "vertex numbers of the mesh"),
  };
}

std::vector<KeySpec> pose_keys(const std::string& path) {
  return {number_key(path + ".rotation_tolerance", "rad", 0, 1, 0.003, "of the sensor's pose about each axis, 1 sigma"),
          number_key(path + ".offset_tolerance", "m", 0, kInfinity, std::numeric_limits<double>::quiet_NaN(),
                     "of the sensor's pose along each axis, 1 sigma; the noise when absent")};
}

void add_image_keys(const std::string& path, const std::string& noise, std::vector<KeySpec>& keys) {
  keys.insert(keys.end(),
              {required_key(path + ".image", Kind::text, "", "topic of the images, sensor_msgs/Image"),
               required_key(path + ".camera_info", Kind::text, "",
                            "topic of the calibration, sensor_msgs/CameraInfo; for a slice fx and fy are pixels a metre"),
               plain_key(path + ".rectified", Kind::boolean, "",
                         "whether the images are rectified, so that P of the calibration counts and K and D do not"),
               positive(path + ".noise", "m", noise)});
  const std::vector<KeySpec> pose = pose_keys(path);
  keys.insert(keys.end(), pose.begin(), pose.end());
}

// These are in the order of OpenCV's predefined dictionaries.
std::vector<std::string> tag_dictionaries() {
  return {"4X4_50",   "4X4_100",  "4X4_250",        "4X4_1000",      "5X5_50",        "5X5_100",        "5X5_250",
          "5X5_1000", "6X6_50",   "6X6_100",        "6X6_250",       "6X6_1000",      "7X7_50",         "7X7_100",
          "7X7_250",  "7X7_1000", "ARUCO_ORIGINAL", "APRILTAG_16h5", "APRILTAG_25h9", "APRILTAG_36h10", "APRILTAG_36h11"};
}

std::vector<KeySpec> observation_keys() {
  std::vector<KeySpec> keys{required_key("observations", Kind::list, "", "what is measured, one sensor an entry")};
  for (const char* kind : {"vertices", "markers", "points"}) {
    const std::string path = std::string("observations[].") + kind;
    const std::string cloud = "sensor_msgs/PointCloud2";
    const std::string what = kind[0] == 'v'   ? cloud + " with a field `vertex`, the mesh vertex of each point"
                             : kind[0] == 'm' ? cloud + " with a field `marker`, the row of `rest` of each point"
                                              : cloud + " of the surface; no point has a name";
    keys.push_back(plain_key(path, Kind::map, "", what));
    keys.push_back(required_key(path + ".topic", Kind::text, "", "of the cloud"));
    keys.push_back(positive(path + ".noise", "m", "1 sigma of a coordinate"));
    const std::vector<KeySpec> pose = pose_keys(path);
    keys.insert(keys.end(), pose.begin(), pose.end());
    if (kind[0] == 'm') {
      keys.push_back(required_key(path + ".rest", Kind::list, "m", "where the markers are at rest, [x, y, z] each"));
    }
  }
  const std::string depth = "observations[].points.depth_camera";
  keys.insert(
      keys.end(),
      {plain_key(depth, Kind::map, "", "the cloud is a depth camera's: leave out what is not the body"),
       positive(depth + ".margin", "m", "around the mesh at rest; points farther away are left out"),
       number_key(depth + ".voxel", "m", 0, kInfinity, 0,
                  "as many points are kept as there are cubes of this edge that hold any; 0: 1/25 of the body's size"),
       integer_key(depth + ".neighbours", 0, 100, 4,
                   "points with fewer others within 2.5 voxels are left out, as flying pixels are")});
  const std::string contour = "observations[].contour";
  keys.push_back(plain_key(contour, Kind::map, "", "outline in images; the sensor's pose comes from tf"));
  add_image_keys(contour, "1 sigma along the outline's normal", keys);
  keys.insert(
      keys.end(),
      {plain_key(contour + ".segmentation", Kind::map, "", "how the outline is found"),
       choice_key(contour + ".segmentation.kind", {"silhouette", "cavity", "mask"}, true,
                  "the body against a darker background, a dark pool inside a bright wall (B-mode), or a mask that another "
                  "program has made: 0 is background, all else the body"),
       plain_key(contour + ".segmentation.seed", Kind::numbers, "pixel",
                 "[u, v] inside the body or the pool; found when absent"),
       plain_key(contour + ".segmentation.roi", Kind::numbers, "pixel",
                 "[u, v, width, height] of the part of the image that holds the body; a mask's body only has to touch it"),
       choice_key(contour + ".segmentation.body", {"bright", "dark", "colour"}, false,
                  "of a silhouette: by what the body differs from its background"),
       plain_key(contour + ".segmentation.colour", Kind::numbers, "",
                 "[red, green, blue] of the body, 0 to 255; needed with `body: colour`"),
       number_key(contour + ".segmentation.tolerance", "", 1, 200, 20,
                  "distance in the plane a*, b* of CIE Lab that is still this colour"),
       choice_key(contour + ".projection", {"silhouette", "slice"}, false,
                  "the outline that a pinhole sees, or the surface cut by the image plane"),
       plain_key(contour + ".region", Kind::text, "", "part of the surface that the outline belongs to; all when absent")});
  const std::string tracks = "observations[].tracks";
  keys.push_back(plain_key(tracks, Kind::map, "",
                           "features of the surface, followed in images from a first one that shows the body at rest; the "
                           "camera's pose comes from tf"));
  add_image_keys(tracks, "1 sigma across the line of sight, at least; the tracker's own where that is larger", keys);
  const std::string features = tracks + ".features";
  keys.insert(
      keys.end(),
      {plain_key(features, Kind::map, "", "what is followed; texture when absent"),
       choice_key(features + ".kind", {"texture", "tags"}, false,
                  "corners of the surface's own texture, or the corners of printed tags (ArUco, AprilTag)"),
       plain_key(features + ".roi", Kind::numbers, "pixel",
                 "[u, v, width, height] of the part of the first image in which features are chosen"),
       integer_key(features + ".most", 10, 2000, 200, "features of a texture that are followed"),
       choice_key(features + ".dictionary", tag_dictionaries(), false, "of the tags, by OpenCV's name without DICT_")});
  const std::string reaction = "observations[].reaction";
  keys.insert(
      keys.end(),
      {plain_key(reaction, Kind::map, "", "force on a region that an effect `moved` moves or a `tool_contact` touches"),
       required_key(reaction + ".topic", Kind::text, "",
                    "geometry_msgs/WrenchStamped; the force on the body, its torque is not used"),
       required_key(reaction + ".region", Kind::text, "", "region of that effect"),
       positive(reaction + ".noise", "N", "1 sigma of a component"),
       number_key(reaction + ".gain", "", 0, 1, 0.1, "relative error of the sensor's scale, 1 sigma"),
       number_key(reaction + ".bias", "N", 0, kInfinity, std::numeric_limits<double>::quiet_NaN(),
                  "constant offset of each component, 1 sigma; 10 % of the largest force when absent"),
       number_key(reaction + ".rotation_tolerance", "rad", 0, 1, 0.05, "of the sensor about each axis, 1 sigma"),
       number_key(reaction + ".rate", "Hz", kPositive, kInfinity, 50,
                  "most measurements a second; messages between them are left out")});
  return keys;
}

std::vector<std::string> estimators() {
  return {
#define ESTIMATOR(name) #name,
#include "settings/estimators.def"
#undef ESTIMATOR
  };
}

std::vector<KeySpec> run_keys() {
  return {
      plain_key("time", Kind::map, "", "of the run"),
      number_key("time.start", "s", -kInfinity, kInfinity, 0,
                 "when the body was at rest, undeformed, after the recording's first stamp"),
      number_key("time.step", "s", kPositive, kInfinity, 0, "of the integration; 0: chosen"),
      plain_key("initial", Kind::map, "", "the body's motion at the start; without it, rest"),
      required_key("initial.velocity", Kind::numbers, "m/s", "[x, y, z] of the whole body, or `from_frames`"),
      choice_key("estimator", estimators(), false,
                 "the default, or the scheme of Yang & Lin 2016 as it was published, to compare with"),
      choice_key("inputs", {"uncertain", "exact"}, false,
                 "whether the interval counts what loads, poses and constants may be off, or takes them as exact"),
      number_key("stale_after", "s", kPositive, kInfinity, 2,
                 "without a measurement or a load for so long the state is `stale`"),
      integer_key("window", 100, 1000000, 4000,
                  "frames that are kept to be reprocessed; when they are too many, the older half becomes the prior"),
      plain_key("map", Kind::map, "",
                "how the modulus varies over the body: in place of the one estimated `young_modulus`, one a patch"),
      integer_key("map.cells", 2, 100, 24, "most patches that the body is divided into"),
      positive("map.length", "m", "distance over which the modulus stays alike"),
      number_key("map.factor", "", kLeastFactor, 100, 2, "1-sigma factor by which it varies from place to place"),
  };
}

}  // namespace

const std::vector<KeySpec>& model_keys() {
  static const std::vector<KeySpec> keys = [] {
    std::vector<KeySpec> all = mesh_keys();
    const auto append = [&](const std::vector<KeySpec>& more) { all.insert(all.end(), more.begin(), more.end()); };
    append(region_keys());
    append({required_key("effects", Kind::list, "",
                         "what the model is made of, one effect an entry; their keys are in effects.md")});
    append(observation_keys());
    append(run_keys());
    return all;
  }();
  return keys;
}

}  // namespace tissue_stiffness
