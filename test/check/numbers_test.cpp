// Numbers of a model file, meshes, topics, clocks and frames: what is said of wrong ones, and nothing of right ones.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "check/check_mesh.hpp"
#include "check/check_numbers.hpp"
#include "check/check_topics.hpp"
#include "says.hpp"

namespace tissue_stiffness {
namespace {

ModelSettings model(const std::string& modulus = "{prior: 24e3, factor: 3}", const std::string& density = "1060",
                    const std::string& more = "- fixed: {region: table}\n") {
  return read_model(parse_yaml("mesh: {file: mesh.vtk}\n"
                               "regions: {table: {box: {min: [-1, -1, -1], max: [1, 1, 0]}}}\n"
                               "effects:\n- inertia: {density: " +
                                   density + "}\n- elasticity: {law: linear, young_modulus: " + modulus +
                                   ", poisson_ratio: 0.45}\n- traction: {region: table, topic: /tool/wrench}\n" + more +
                                   "observations:\n- vertices: {topic: /tissue/vertices, noise: 1e-4}\n",
                               "model.yaml"),
                    "");
}

TEST(CheckNumbers, SayNothingOfAPlausibleModel) {
  EXPECT_TRUE(nothing(check_numbers(model())));
  EXPECT_TRUE(nothing(check_numbers(model("{prior: 500, factor: 4}", "30", "- contact_plane: {}\n"))));
  EXPECT_TRUE(nothing(check_numbers(model("12e3", "1060", "- moved: {region: table, topic: /jaw/pose}\n"))));
}

TEST(CheckNumbers, NameAPriorInKilopascal) {
  EXPECT_TRUE(says(check_numbers(model("{prior: 24, factor: 3}")), {"young_modulus", "24 Pa", "kPa", "write 24000"}));
  EXPECT_TRUE(says(check_numbers(model("12")), {"young_modulus", "12 Pa", "write 12000"}));
}

TEST(CheckNumbers, NameADensityInGramsPerCubicCentimetre) {
  EXPECT_TRUE(says(check_numbers(model("12e3", "1.06")), {"density", "1.06 kg/m^3", "g/cm^3", "write 1060"}));
}

TEST(CheckNumbers, NameABodyThatNothingHolds) {
  EXPECT_TRUE(says(check_numbers(model("12e3", "1060", "")), {"effects", "nothing holds the body", "fixed"}));
}

TEST(CheckMesh, NamesAMeshInMillimetres) {
  MeshSettings mesh;
  mesh.file = "liver.stl";
  EXPECT_TRUE(nothing(check_extent(mesh, {0.1, 0.08, 0.05}, 4e-4)));
  EXPECT_TRUE(says(check_extent(mesh, {100.0, 80.0, 50.0}, 4e5), {"mesh.scale", "100 x 80 x 50 m", "scale: 0.001"}));
  mesh.scale = 1e-3;
  EXPECT_TRUE(says(check_extent(mesh, {1e-5, 8e-5, 5e-5}, 4e-14), {"mesh.scale (0.001)", "in m already", "scale: 1"}));
}

TEST(CheckMesh, NamesEdgesThatMakeTooManyTetrahedra) {
  MeshSettings mesh;
  mesh.max_edge_length = 0.01;
  EXPECT_TRUE(nothing(check_extent(mesh, {0.1, 0.08, 0.05}, 4e-4)));
  mesh.max_edge_length = 1e-5;
  EXPECT_TRUE(says(check_extent(mesh, {0.1, 0.08, 0.05}, 4e-4), {"mesh.max_edge_length", "tetrahedra"}));
}

TEST(CheckMesh, ReadsTheFileAlone) {
  MeshSettings mesh;
  mesh.max_edge_length = 1e-3;  // TetGen would fill a cube of 1 m with 10^10
  mesh.file = std::string(TISSUE_STIFFNESS_TEST_DATA) + "/meshing/cube.obj";
  mesh.scale = 1000.0;
  EXPECT_TRUE(says(check_mesh_file(mesh), {"mesh.scale", "cube.obj"}));
}

const Topic kCloud{"/tissue/vertices", "sensor_msgs/PointCloud2"};
const Topic kWrench{"/tool/wrench", "geometry_msgs/WrenchStamped"};

TEST(CheckTopics, FindThoseOfTheModel) {
  EXPECT_TRUE(nothing(check_topics(needed_topics(model()), {kCloud, kWrench}, "the recording lacks")));
}

TEST(CheckTopics, SuggestTheSimilarNameAndThoseOfTheType) {
  const Topic near{"/tool/wrenches", "std_msgs/String"}, alike{"/force_sensor", "geometry_msgs/WrenchStamped"};
  EXPECT_TRUE(says(check_topics(needed_topics(model()), {kCloud, near, alike}, "the recording lacks"),
                   {"the recording lacks the topic /tool/wrench", "did you mean `/tool/wrenches`", "/force_sensor"}));
  const Topic elsewhere{"/robot/left/wrench", "geometry_msgs/WrenchStamped"};
  EXPECT_TRUE(says(check_topics(needed_topics(model()), {kCloud, elsewhere}, "no node publishes"),
                   {"no node publishes the topic /tool/wrench", "did you mean `/robot/left/wrench`"}));
}

TEST(CheckTopics, NameATopicOfAnotherType) {
  const Topic plain{"/tool/wrench", "geometry_msgs/Wrench"};
  EXPECT_TRUE(says(check_topics(needed_topics(model()), {kCloud, plain}, "the recording lacks"),
                   {"/tool/wrench", "geometry_msgs/Wrench,", "geometry_msgs/WrenchStamped"}));
}

/// Stamped and recorded at `rate` from `begin` to `end` [s], recorded `late`.
TopicTimes times(const std::string& topic, double rate, double begin, double end, double late = 0.0) {
  TopicTimes out{topic, {}, {}};
  for (double t = begin; t < end; t += 1.0 / rate) {
    out.stamps.push_back(t);
    out.arrivals.push_back(t + late);
  }
  return out;
}

TEST(CheckTimes, SayNothingOfTopicsThatGoOnTogether) {
  const std::vector<TopicTimes> both{times("/tissue/vertices", 30.0, 0.0, 3.0),
                                     times("/tool/wrench", 200.0, 0.01, 2.9, 0.1)};
  EXPECT_TRUE(nothing(check_stops(both)));
  EXPECT_TRUE(nothing(check_clocks(both)));
}

TEST(CheckTimes, NameATopicThatStopped) {
  EXPECT_TRUE(says(check_stops({times("/tissue/vertices", 30.0, 0.0, 3.0), times("/tool/wrench", 200.0, 0.0, 1.0)}),
                   {"/tool/wrench stopped", "before the other topics"}));
}

TEST(CheckTimes, NameClocksThatAreApart) {
  EXPECT_TRUE(says(check_clocks({times("/tissue/vertices", 30.0, 0.0, 3.0), times("/tool/wrench", 200.0, 100.0, 103.0)}),
                   {"/tool/wrench", "share no instant", "97", "clock"}));
  EXPECT_TRUE(says(check_clocks({times("/tissue/vertices", 30.0, 0.0, 3.0), times("/tool/wrench", 200.0, 1.0, 4.0, -1.0)}),
                   {"/tool/wrench", "1 s ahead of", "clock"}));
}

TEST(CheckFrames, NameOneThatNoTransformJoins) {
  const std::vector<std::pair<std::string, std::string>> transforms{{"model", "base"}, {"tool", "tip"}, {"base", "camera"}};
  EXPECT_TRUE(nothing(check_frames({{"/tissue/vertices", "camera"}, {"/x", "model"}}, transforms, "model")));
  EXPECT_TRUE(says(check_frames({{"/tool/wrench", "tip"}}, transforms, "model"),
                   {"/tool/wrench", "no transform", "`tip`", "`model`", "base, camera"}));
}

}  // namespace
}  // namespace tissue_stiffness
