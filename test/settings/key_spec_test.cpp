#include "settings/key_spec.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// Together they have every key.
const char* const kModels[] = {
    R"(mesh: {file: mesh.stl, scale: 0.001, scale_tolerance: 0.01, surface_tolerance: 5.0e-4, max_edge_length: 0.01, order: 1, boundary: faceted, discretisation_error: false}
regions:
  clamp: {box: {min: [0, 0, 0], max: [1, 1, 0]}}
  ball: {sphere: {center: [0, 0, 1], radius: 0.5}}
  egg: {ellipsoid: {center: [0, 0, 0], radii: [1, 2, 3]}}
  half: {half_space: {point: [0, 0, 0], normal: [0, 0, 2]}}
  some: {vertices: [3, 1, 2]}
effects: [inertia: {density: 1060}]
observations:
- vertices: {topic: /v, noise: 3e-4, rotation_tolerance: 0.01, offset_tolerance: 1e-3}
- markers: {topic: /m, noise: 1e-4, rotation_tolerance: 0.01, offset_tolerance: 1e-3, rest: [[1, 2, 3]]}
- points: {topic: /p, noise: 1e-3, rotation_tolerance: 0.01, offset_tolerance: 1e-3, depth_camera: {margin: 0.02, voxel: 0.003, neighbours: 5}}
- reaction: {topic: /f, region: ball, noise: 0.01, gain: 0.02, bias: 0.03, rotation_tolerance: 0.04, rate: 100}
- contour: {image: /i, rotation_tolerance: 0.01, offset_tolerance: 1e-3, camera_info: /c, segmentation: {kind: cavity, seed: [1, 2], roi: [3, 4, 50, 60]}, projection: slice, rectified: true, noise: 6e-4, region: egg}
- contour: {image: /i, camera_info: /c, noise: 6e-4, segmentation: {kind: silhouette, body: colour, colour: [120, 60, 160], tolerance: 30}}
- tracks: {image: /i, camera_info: /c, rectified: false, noise: 2e-5, rotation_tolerance: 0.01, offset_tolerance: 1e-3, features: {kind: texture, most: 50, roi: [3, 4, 50, 60]}}
- tracks: {image: /i, camera_info: /c, noise: 2e-5, features: {kind: tags, dictionary: APRILTAG_36h11}}
time: {start: 0.09, step: 0.004}
initial: {velocity: [0, 0, -4]}
estimator: paper
map: {cells: 8, length: 0.02, factor: 3}
window: 200
inputs: exact
stale_after: 1
)",
    R"(mesh: {revolve: {contour: first, axis: [0, 0, 1], max_edge_length: 0.01}}
effects: [inertia: {density: 1060}]
observations: [points: {topic: /p, noise: 1e-3}]
)",
    R"(mesh: {extrude: {contour: first, depth: 0.01, max_edge_length: 0.01}, refine: 1}
effects: [inertia: {density: 1060}]
observations: [points: {topic: /p, noise: 1e-3}]
)"};

/// Paths of all keys below a value, as the specs write them.
void collect(const Value& value, const std::string& path, std::set<std::string>& paths) {
  if (path == "effects") return;  // their keys are the effects' own
  if (value.type() == Value::Type::list) {
    for (const Value& item : value.items()) collect(item, path + "[]", paths);
  } else if (value.type() == Value::Type::map) {
    for (const std::string& key : value.keys()) {
      const std::string below = path.empty() ? key : path == "regions" ? "regions.*" : path + "." + key;
      if (below != "regions.*") paths.insert(below);
      collect(value.at(key), below, paths);
    }
  }
}

TEST(KeySpec, TheDocumentedKeysAreThoseThatAreRead) {
  std::set<std::string> read, documented;
  for (const char* text : kModels) {
    const Value root = parse_yaml(text, "model.yaml");
    EXPECT_NO_THROW(read_model(root, "/"));  // every key is read, or it would throw
    collect(parse_yaml(text, "model.yaml"), "", read);
  }
  for (const KeySpec& key : model_keys()) documented.insert(key.path);
  EXPECT_EQ(documented, read);
  EXPECT_EQ(documented.size(), model_keys().size()) << "one spec a key";
}

TEST(KeySpec, EachHasAMeaningAndADefaultThatIsAllowed) {
  for (const KeySpec& key : model_keys()) {
    EXPECT_FALSE(key.meaning.empty()) << key.path;
    const bool number = key.kind == KeySpec::Kind::number || key.kind == KeySpec::Kind::integer;
    EXPECT_TRUE(!number || key.lower < key.upper) << key.path;
    EXPECT_TRUE(key.kind != KeySpec::Kind::integer || (key.lower <= key.value && key.value <= key.upper)) << key.path;
    EXPECT_EQ(key.kind == KeySpec::Kind::choice, !key.choices.empty()) << key.path;
  }
}

TEST(KeySpec, AnUnknownPathIsAFaultOfOurs) {
  EXPECT_THROW(find_key(model_keys(), "mesh.colour"), std::logic_error);
}

TEST(KeySpec, ReadsWhatIsThereAndGivesTheDefaultOtherwise) {
  const Value map = parse_yaml("{scale: 0.5, order: 1, discretisation_error: false, kind: b, name: x}", "m");
  const Value none = parse_yaml("{}", "m");
  const KeySpec scale{"a.scale", KeySpec::Kind::number, "m", 0, 1, {}, false, 0.25, "", "x"};
  EXPECT_EQ(read_number(map, scale), 0.5);
  EXPECT_EQ(read_number(none, scale), 0.25);
  const KeySpec kind{"kind", KeySpec::Kind::choice, "", 0, 0, {"a", "b"}, false, 0, "", "x"};
  EXPECT_EQ(read_choice(map, kind), "b");
  EXPECT_EQ(read_choice(none, kind), "a");
  const KeySpec name{"name", KeySpec::Kind::text, "", 0, 0, {}, true, 0, "", "x"};
  EXPECT_EQ(read_text(map, name), "x");
  EXPECT_THROW(read_text(none, name), InputError);
  EXPECT_EQ(read_integer(map, find_key(model_keys(), "mesh.order")), 1);
  EXPECT_EQ(read_integer(none, find_key(model_keys(), "mesh.order")), 2);
  EXPECT_FALSE(read_boolean(map, find_key(model_keys(), "mesh.discretisation_error")));
  EXPECT_TRUE(read_boolean(none, find_key(model_keys(), "mesh.discretisation_error")));
  const KeySpec narrow{"scale", KeySpec::Kind::number, "m", 0, 0.1, {}, false, 0.05, "", "x"};
  EXPECT_THROW(read_number(map, narrow), InputError);
}

}  // namespace
}  // namespace tissue_stiffness
