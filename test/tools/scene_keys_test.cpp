#include "tools/scene_keys.hpp"

#include <set>

#include "tools/scene.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

// Every key but the model's.
const char* const kSimulation = R"(effects:
- inertia: {density: 1060}
- elasticity: {law: linear, young_modulus: 1e4, poisson_ratio: 0.45}
- traction: {region: all, topic: /w}
- moved: {region: all, topic: /m}
observations:
- vertices: {topic: /v, noise: 1e-4}
- points: {topic: /p, noise: 1e-4}
- vertices: {topic: /u, noise: 1e-4}
- contour: {image: /i, camera_info: /c, noise: 1e-4}
- contour: {image: /s, camera_info: /d, projection: slice, noise: 1e-4}
simulation:
  duration: 1
  rate: 30
  step: 0.001
  spectral_radius: 0.9
  refine: 1
  seed: 2
  loads:
    /w:
      rate: 100
      noise: 0.1
      terms:
      - {direction: [0, 0, 1], ramp: {from: 0, to: 1, start: 0, end: 1}}
      - {direction: [0, 0, 1], sine: {amplitude: 1, frequency: 1, phase: 0.1}}
      - {direction: [0, 0, 1], raised_cosine: {amplitude: 1, frequency: 1}}
      - {direction: [0, 0, 1], steps: {times: [0, 1], values: [1, 2]}}
      - {direction: [0, 0, 1], csv: {file: course.csv}}
    /m:
      rate: 100
      position: [0, 0, 1]
      terms:
      - {axis: [0, 0, 1], sine: {amplitude: 0.1, frequency: 1}}
  sensors:
    /v: {noise: 1e-4, memory: 0.5, every: 2}
    /p: {count: 100}
    /u: {ids: [1, 2]}
    /i: {size: [64, 64], blur: 1, focal_length: 100, distortion: [0.1, 0, 0, 0], distortion_model: equidistant, position: [0, -1, 0], target: [0, 0, 0], up: [0, 0, 1]}
    /s: {pixels_per_metre: 100, apex: [0, 0, -1], axis: [0, 0, 1], lateral: [1, 0, 0], sector: 60, depth: 0.1, drop_out: 0.1}
)";

void collect(const Value& value, const std::string& path, std::set<std::string>& paths) {
  if (value.type() == Value::Type::list) {
    for (const Value& item : value.items()) collect(item, path + "[]", paths);
  } else if (value.type() == Value::Type::map) {
    for (const std::string& key : value.keys()) {
      const bool topic = path == "simulation.loads" || path == "simulation.sensors";
      const std::string below = path + (topic ? ".*" : "." + key);
      paths.insert(below);
      collect(value.at(key), below, paths);
    }
  }
}

class SceneKeys : public Workbench {};

TEST_F(SceneKeys, TheDocumentedKeysAreThoseThatAreRead) {
  write("course.csv", "0,1\n1,2\n");
  const std::string text =
      "mesh: {file: bar.vtk}\nregions: {all: {box: {min: [-1, -1, -1], max: [1, 1, 1]}}}\n" + std::string(kSimulation);
  const Scene scene = load_scene(write("scene.yaml", text));  // every key is read, or it would throw
  EXPECT_EQ(scene.seed, 2U);
  EXPECT_EQ(scene.sensors[1].points, 100);
  std::set<std::string> read{"simulation"}, documented;
  collect(parse_yaml(text, "scene.yaml").at("simulation"), "simulation", read);
  for (const KeySpec& key : scene_keys()) {
    EXPECT_FALSE(key.meaning.empty()) << key.path;
    documented.insert(key.path);
  }
  EXPECT_EQ(documented, read);
  EXPECT_EQ(documented.size(), scene_keys().size()) << "one spec a key";
}

}  // namespace
}  // namespace tissue_stiffness
