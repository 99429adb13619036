#include "tissue_stiffness/settings/model_settings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;

const char* const whole_model = R"(mesh: {file: mesh.stl, scale: 0.001, max_edge_length: 0.01, order: 1}
regions:
  clamp: {box: {min: [0, 0, 0], max: [1, 1, 0]}}
  ball: {sphere: {center: [0, 0, 1], radius: 0.5}}
  egg: {ellipsoid: {center: [0, 0, 0], radii: [1, 2, 3]}}
  half: {half_space: {point: [0, 0, 0], normal: [0, 0, 2]}}
  some: {vertices: [3, 1, 2]}
effects:
- inertia: {density: 1060}
- elasticity: {law: linear, young_modulus: {prior: 30e3, factor: 3}, poisson_ratio: 0.45}
- added_mass: {region: clamp, mass: 1}
- added_mass: {region: ball, mass: 2}
- geometric_nonlinearity
- mass_damping:
observations:
- vertices: {topic: /v, noise: 3e-4}
- markers: {topic: /m, noise: 1e-4, rest: [[1, 2, 3], [4, 5, 6]]}
- points: {topic: /p, noise: 1e-3}
- contour: {image: /i, camera_info: /c, segmentation: {kind: cavity, seed: [10, 20.5], roi: [1, 2, 300, 200]}, projection: slice, noise: 6e-4, region: egg}
time: {start: 0.09, step: 0.004}
initial: {velocity: [0, 0, -4]}
estimator: paper
)";

ModelSettings read(const std::string& text) {
  return read_model(parse_yaml(text, "model.yaml"), "folder");
}

TEST(ModelSettings, ReadsEveryKey) {
  const ModelSettings model = read(whole_model);
  EXPECT_EQ(model.name, "model.yaml");
  EXPECT_EQ(model.mesh.file, "folder/mesh.stl");
  EXPECT_EQ(model.mesh.scale, 0.001);
  EXPECT_EQ(model.mesh.max_edge_length, 0.01);
  EXPECT_EQ(model.mesh.order, 1);
  ASSERT_EQ(model.regions.size(), 5u);
  EXPECT_EQ(std::get<BoxShape>(model.regions[0].shape).max, Eigen::Vector3d(1, 1, 0));
  EXPECT_EQ(std::get<SphereShape>(model.regions[1].shape).radius, 0.5);
  EXPECT_EQ(std::get<EllipsoidShape>(model.regions[2].shape).radii, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<HalfSpaceShape>(model.regions[3].shape).normal, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(std::get<VertexShape>(model.regions[4].shape).vertices, (std::vector<int>{3, 1, 2}));
  ASSERT_EQ(model.effects.size(), 6u);
  EXPECT_EQ(model.effects[2].label, "added_mass");
  EXPECT_EQ(model.effects[3].label, "added_mass#2");
  EXPECT_EQ(model.effects[3].name, "added_mass");
  EXPECT_EQ(model.effects[4].arguments.type(), Value::Type::map);
  EXPECT_EQ(model.effects[5].arguments.type(), Value::Type::map);
  ASSERT_EQ(model.observations.size(), 4u);
  EXPECT_EQ(model.observations[0].topic, "/v");
  EXPECT_EQ(model.observations[0].noise, 3e-4);
  EXPECT_EQ(model.observations[1].rest.col(1), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(model.observations[2].kind, ObservationSettings::Kind::points);
  const ObservationSettings& contour = model.observations[3];
  EXPECT_EQ(contour.topic, "/i");
  EXPECT_EQ(contour.camera_info, "/c");
  EXPECT_EQ(contour.segmentation.kind, SegmentationSettings::Kind::cavity);
  EXPECT_EQ(*contour.segmentation.seed, Eigen::Vector2d(10, 20.5));
  ASSERT_TRUE(contour.segmentation.roi);
  EXPECT_EQ(contour.segmentation.roi->v, 2);
  EXPECT_EQ(contour.segmentation.roi->width, 300);
  EXPECT_EQ(contour.projection, ObservationSettings::Projection::slice);
  EXPECT_EQ(contour.region, "egg");
  EXPECT_EQ(model.time.start, 0.09);
  EXPECT_EQ(model.time.step, 0.004);
  EXPECT_EQ(model.initial.kind, InitialSettings::Kind::velocity);
  EXPECT_EQ(model.initial.velocity, Eigen::Vector3d(0, 0, -4));
  EXPECT_EQ(model.estimator, "paper");
}

TEST(ModelSettings, LeavesTheEffectsArgumentsToTheEffectsLayer) {
  const ModelSettings model = read(whole_model);
  const Value& elasticity = model.effects[1].arguments;
  EXPECT_EQ(elasticity.path(), "model.yaml:10: effects[1].elasticity");
  EXPECT_EQ(elasticity.at("law").as_text(), "linear");
  EXPECT_THROW(elasticity.require_all_read(), InputError);
  elasticity.at("young_modulus").as_quantity(0.0, 1e12, "Pa");
  elasticity.at("poisson_ratio").as_number(0.0, 0.5, "");
  EXPECT_NO_THROW(elasticity.require_all_read());
}

/// Replaces one line of the whole model; an empty `line` appends.
std::string changed(const std::string& line, const std::string& replacement) {
  std::string text = whole_model;
  if (line.empty()) return text + replacement + "\n";
  const std::size_t at = text.find(line);
  EXPECT_NE(at, std::string::npos) << line;
  return text.replace(at, line.size(), replacement);
}

TEST(ModelSettings, AMapIsAskedFor) {
  EXPECT_FALSE(read(whole_model).map);
  const ModelSettings model = read(std::string(whole_model) + "map: {length: 0.02}\n");
  ASSERT_TRUE(model.map);
  EXPECT_EQ(model.map->length, 0.02);
  EXPECT_EQ(model.map->cells, 24);
  EXPECT_EQ(model.map->factor, 2.0);
}

TEST(ModelSettings, RevolveAndExtrudeTakeTheirOwnKeys) {
  const std::string mesh = "{file: mesh.stl, scale: 0.001, max_edge_length: 0.01, order: 1}";
  const ModelSettings revolved =
      read(changed(mesh, "{revolve: {contour: first, axis: [0, 3, 0], max_edge_length: 0.01}, order: 1}"));
  EXPECT_EQ(revolved.mesh.source, MeshSettings::Source::revolve);
  EXPECT_EQ(revolved.mesh.axis, Eigen::Vector3d::UnitY());
  EXPECT_EQ(revolved.mesh.max_edge_length, 0.01);
  const ModelSettings extruded = read(changed(mesh, "{extrude: {contour: first, depth: 0.02}}"));
  EXPECT_EQ(extruded.mesh.source, MeshSettings::Source::extrude);
  EXPECT_EQ(extruded.mesh.depth, 0.02);
  EXPECT_EQ(extruded.mesh.order, 2);
}

struct Malformed {
  std::string line, replacement;
  std::vector<std::string> fragments;
};

TEST(ModelSettings, RefusesWhatIsWrongAndSaysWhere) {
  const std::vector<Malformed> table = {
      {"", "colour: red", {"model.yaml:23: colour", "unknown key `colour`", "effects, estimator, initial, inputs, map"}},
      {"estimator: paper", "estimatr: paper", {"model.yaml:22: estimatr", "did you mean `estimator`?"}},
      {"estimator: paper", "estimator: kalman", {"model.yaml:22: estimator", "`kalman`", "unscented, paper"}},
      {"", "map: {cells: 8}", {"model.yaml:23: map", "no key `length`"}},
      {"", "map: {length: 0.02, cells: 1}", {"model.yaml:23: map.cells", "found 1", "2"}},
      {"", "map: {length: 0.02, factor: 1}", {"model.yaml:23: map.factor", "found 1", "1.01"}},
      {"", "map: {length: 0.02, patches: 8}", {"model.yaml:23: map.patches", "unknown key"}},
      {"", "mesh: {file: x}", {"model.yaml:23: mesh", "twice"}},
      {"mesh: {file", "mash: {file", {"model.yaml: found no key `mesh`", "did you mean `mash`?"}},
      {"{file: mesh.stl,", "{", {"model.yaml:1: mesh", "exactly one of file, revolve, extrude"}},
      {"file: mesh.stl,", "file: mesh.stl, extrude: {},", {"model.yaml:1: mesh", "exactly one of"}},
      {"file: mesh.stl,", "revolve: {contour: first, axis: [0, 0, 0]},", {"mesh.revolve.axis", "[0, 0, 0]", "not zero"}},
      {"file: mesh.stl,", "revolve: {contour: last, axis: [0, 0, 1]},", {"mesh.revolve.contour", "`last`", "first"}},
      {"file: mesh.stl,", "revolve: {contour: first},", {"model.yaml:1: mesh.revolve", "no key `axis`"}},
      {"file: mesh.stl,", "extrude: {contour: first},", {"model.yaml:1: mesh.extrude", "no key `depth`"}},
      {"file: mesh.stl,", "extrude: {contour: first, depth: 0},", {"mesh.extrude.depth", "found 0", "> 0 [m]"}},
      {"file: mesh.stl, scale: 0.001", "extrude: {contour: first, depth: 1}, scale: 1", {"mesh.scale", "unknown key"}},
      {"scale: 0.001", "scale: -1", {"model.yaml:1: mesh.scale", "found -1", "> 0"}},
      {"order: 1", "order: 3", {"model.yaml:1: mesh.order", "found 3", "from 1 to 2"}},
      {"order: 1", "order: 1, refine: 3", {"model.yaml:1: mesh.refine", "found 3", "from 0 to 2"}},
      {"max_edge_length: 0.01", "max_edge_length: 0", {"model.yaml:1: mesh.max_edge_length", "found 0", "> 0 [m]"}},
      {"max: [1, 1, 0]", "max: [1, -1, 0]", {"regions.clamp.box.min", "min <= max = [1, -1, 0]"}},
      {"max: [1, 1, 0]", "max: [1, 1]", {"model.yaml:3: regions.clamp.box.max", "[1, 1]", "three numbers"}},
      {"{sphere: {center: [0, 0, 1], radius: 0.5}}", "{spehre: {}}", {"regions.ball", "spehre", "box, sphere"}},
      {"radius: 0.5", "radius: .nan", {"model.yaml:4: regions.ball.sphere.radius", "`.nan`", "a number > 0"}},
      {"radius: 0.5", "radius: 0.5, unit: mm", {"model.yaml:4: regions.ball.sphere.unit", "unknown key", "center, radius"}},
      {"radii: [1, 2, 3]", "radii: [1, 0, 3]", {"regions.egg.ellipsoid.radii", "[1, 0, 3]", "> 0"}},
      {"normal: [0, 0, 2]", "normal: [0, 0, 0]", {"regions.half.half_space.normal", "a direction, not zero"}},
      {"vertices: [3, 1, 2]", "vertices: [3, -1]", {"model.yaml:7: regions.some.vertices[1]", "found -1", "whole number"}},
      {"vertices: [3, 1, 2]", "vertices: []", {"regions.some.vertices", "an empty list", "at least one"}},
      {"- inertia: {density: 1060}", "- {inertia: {}, gravity: {}}", {"model.yaml:9: effects[0]", "one effect an entry"}},
      {"- inertia: {density: 1060}", "- 5", {"model.yaml:9: effects[0]", "found 5", "one effect an entry"}},
      {"- inertia: {density: 1060}", "- inertia: 1060", {"effects[0].inertia", "found 1060", "a map of the effect's keys"}},
      {"topic: /v, noise: 3e-4", "topic: /v", {"model.yaml:16: observations[0].vertices", "no key `noise`"}},
      {"topic: /v, noise: 3e-4", "noise: 3e-4", {"model.yaml:16: observations[0].vertices", "no key `topic`"}},
      {"noise: 3e-4", "noise: 0", {"model.yaml:16: observations[0].vertices.noise", "found 0", "> 0 [m]"}},
      {"noise: 3e-4",
       "noise: 3e-4, rest: []",
       {"observations[0].vertices.rest", "unknown key `rest`", "noise, offset_tolerance"}},
      {"- vertices:", "- vertexes:", {"model.yaml:16: observations[0].vertexes", "did you mean `vertices`?", "contour"}},
      {"rest: [[1, 2, 3], [4, 5, 6]]", "rest: []", {"observations[1].markers.rest", "an empty list"}},
      {"[4, 5, 6]", "[4, 5]", {"model.yaml:17: observations[1].markers.rest[1]", "[4, 5]", "three numbers"}},
      {"kind: cavity", "kind: cave", {"contour.segmentation.kind", "`cave`", "silhouette, cavity, mask"}},
      {"seed: [10, 20.5]", "seed: [10]", {"contour.segmentation.seed", "[10]", "[u, v]"}},
      {"roi: [1, 2, 300, 200]", "roi: [1, 2, 300]", {"contour.segmentation.roi", "[1, 2, 300]", "[u, v, width, height]"}},
      {"roi: [1, 2, 300, 200]", "roi: [1, 2, 300, 20]", {"contour.segmentation.roi[3]", "found 20", "32 to 16384"}},
      {"projection: slice", "projection: fisheye", {"contour.projection", "`fisheye`", "silhouette, slice"}},
      {"camera_info: /c, ", "", {"model.yaml:19: observations[3].contour", "no key `camera_info`"}},
      {"region: egg", "region: eg", {"observations[3].contour.region", "`eg` (did you mean `egg`?)", "clamp, ball, egg"}},
      {"step: 0.004", "step: 0", {"model.yaml:20: time.step", "found 0", "> 0 [s]"}},
      {"step: 0.004", "stop: 0.004", {"model.yaml:20: time.stop", "did you mean `step`?", "start, step"}},
      {"velocity: [0, 0, -4]", "velocity: from_frame", {"initial.velocity", "did you mean `from_frames`?"}},
      {"velocity: [0, 0, -4]", "velocity: 4", {"model.yaml:21: initial.velocity", "found 4", "from_frames"}},
  };
  for (const Malformed& row : table) {
    try {
      read(changed(row.line, row.replacement));
      ADD_FAILURE() << "accepted: " << row.replacement;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      for (const std::string& fragment : row.fragments) {
        EXPECT_NE(message.find(fragment), std::string::npos) << "`" << fragment << "` is not in: " << message;
      }
    }
  }
}

TEST(ModelSettings, ReadsByWhatABodyDiffersFromItsBackground) {
  const auto segmentation = [](const std::string& keys) {
    return read(
               "mesh: {file: m}\neffects: [inertia: {density: 1}]\nobservations:\n- contour: {image: /i, camera_info: /c, "
               "noise: 1e-3, segmentation: {" +
               keys + "}}\n")
        .observations.at(0)
        .segmentation;
  };
  using Body = SegmentationSettings::Body;
  EXPECT_EQ(segmentation("kind: silhouette").body, Body::bright);
  EXPECT_EQ(segmentation("kind: silhouette, body: dark").body, Body::dark);
  const SegmentationSettings colour = segmentation("kind: silhouette, body: colour, colour: [1, 2, 3], tolerance: 7");
  EXPECT_EQ(colour.body, Body::colour);
  EXPECT_EQ(colour.colour, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(colour.tolerance, 7.0);
  EXPECT_THROW(segmentation("kind: silhouette, body: colour"), InputError);
  EXPECT_THROW(segmentation("kind: silhouette, body: colour, colour: [1, 2, 256]"), InputError);
  EXPECT_THROW(segmentation("kind: silhouette, colour: [1, 2, 3]"), InputError) << "a colour that nobody reads";
  EXPECT_THROW(segmentation("kind: cavity, body: dark"), InputError);
}

TEST(ModelSettings, ReadsWhichFeaturesAreFollowed) {
  const auto features = [](const std::string& keys) {
    return read(
               "mesh: {file: m}\neffects: [inertia: {density: 1}]\nobservations:\n- tracks: {image: /i, camera_info: /c, "
               "noise: 1e-5" +
               keys + "}\n")
        .observations.at(0)
        .features;
  };
  using Kind = FeatureSettings::Kind;
  EXPECT_EQ(features("").kind, Kind::texture);
  EXPECT_EQ(features("").most, 200);
  EXPECT_FALSE(features("").roi);
  const FeatureSettings texture = features(", features: {kind: texture, most: 50, roi: [1, 2, 40, 50]}");
  EXPECT_EQ(texture.most, 50);
  ASSERT_TRUE(texture.roi);
  EXPECT_EQ(texture.roi->height, 50);
  const FeatureSettings tags = features(", features: {kind: tags, dictionary: APRILTAG_36h11}");
  EXPECT_EQ(tags.kind, Kind::tags);
  EXPECT_EQ(tags.dictionary, 20) << "its number in OpenCV";
  EXPECT_EQ(features(", features: {kind: tags}").dictionary, 0);
  EXPECT_THROW(features(", features: {kind: tags, most: 50}"), InputError) << "a number that nobody reads";
  EXPECT_THROW(features(", features: {dictionary: 4X4_50}"), InputError);
  EXPECT_THROW(features(", features: {kind: tags, dictionary: 36h11}"), InputError);
}

TEST(ModelSettings, RefusesWhatIsNotAModel) {
  EXPECT_THROW(read(""), InputError);
  EXPECT_THROW(read("[1, 2]"), InputError);
  EXPECT_THROW(read("mesh: 3"), InputError);
  EXPECT_THROW(read("mesh: {file: m}\neffects: []\nobservations: []"), InputError);
  EXPECT_THROW(read("mesh: {file: m}\neffects: [fixed]\nobservations: []"), InputError);
  EXPECT_THROW(load_model("no_such_file.yaml"), InputError);
}

TEST(ModelSettings, TakesEffectsInAndOut) {
  ModelSettings model = read_model(
      parse_yaml(
          "mesh: {file: x.vtk}\neffects:\n- inertia: {density: 1000}\nobservations:\n- vertices: {topic: /v, noise: 1}\n",
          "m.yaml"),
      "");
  add_effect(model, "mass_damping: {alpha: 1}");
  add_effect(model, "mass_damping: {alpha: 2}");
  EXPECT_EQ(model.effects.back().label, "mass_damping#2");
  remove_effect(model, "mass_damping");
  EXPECT_EQ(model.effects.size(), 2U);
  EXPECT_EQ(model.effects.back().label, "mass_damping");
  remove_effect(model, "mass_damping");
  try {
    remove_effect(model, "mass_damping");
    FAIL() << "removed what is not there";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("mass_damping; allowed: one of the model's: inertia"), std::string::npos)
        << error.what();
  }
}

TEST(ModelSettings, ReadsEveryExampleModel) {
  int count = 0;
  for (const std::string folder : {"/cases", "/recordings"}) {
    const fs::path root = TISSUE_STIFFNESS_SHARED + folder;
    if (!fs::is_directory(root)) GTEST_SKIP() << "no example models in " << root;
    for (const fs::directory_entry& entry : fs::directory_iterator(root)) {
      const fs::path file = entry.path() / "model.yaml";
      if (!fs::exists(file)) continue;
      SCOPED_TRACE(file);
      const ModelSettings model = load_model(file.string());
      const bool from_file = model.mesh.source == MeshSettings::Source::file;
      EXPECT_EQ(fs::exists(model.mesh.file), from_file);
      EXPECT_GE(model.effects.size(), 4u);
      EXPECT_EQ(model.observations.size(), 1u);
      ++count;
    }
  }
  EXPECT_GE(count, 20);
}

}  // namespace
}  // namespace tissue_stiffness
