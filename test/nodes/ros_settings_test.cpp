#include "nodes/ros_settings.hpp"

#include <XmlRpcValue.h>
#include <gtest/gtest.h>

#include "expect_input_error.hpp"

namespace tissue_stiffness {
namespace {

using XmlRpc::XmlRpcValue;

/// The parameters that `rosparam load` makes of a model file: 30e3 and 3e-4 stay text in its YAML reader.
XmlRpcValue model_parameters() {
  XmlRpcValue modulus, elasticity, effect, effects, vertices, observation, observations, mesh, root;
  modulus["prior"] = "30e3";
  modulus["factor"] = 3;
  elasticity["law"] = "linear";
  elasticity["young_modulus"] = modulus;
  elasticity["poisson_ratio"] = 0.45;
  effect["elasticity"] = elasticity;
  effects[0] = effect;
  vertices["topic"] = "/tissue/vertices";
  vertices["noise"] = "3e-4";
  observation["vertices"] = vertices;
  observations[0] = observation;
  mesh["file"] = "mesh.vtk";
  root["mesh"] = mesh;
  root["effects"] = effects;
  root["observations"] = observations;
  return root;
}

TEST(RosSettings, ReadsTheKeysOfAModelFile) {
  const ModelSettings model = read_model(to_value(model_parameters(), "parameters of /node"), "/data");
  EXPECT_EQ(model.mesh.file, "/data/mesh.vtk");
  ASSERT_EQ(model.observations.size(), 1U);
  EXPECT_DOUBLE_EQ(model.observations[0].noise, 3e-4);
  ASSERT_EQ(model.effects.size(), 1U);
  const Quantity modulus = model.effects[0].arguments.at("young_modulus").as_quantity(0, 1e12, "Pa");
  EXPECT_EQ(modulus.kind, Quantity::Kind::log_normal);
  EXPECT_DOUBLE_EQ(modulus.value, 30e3);
}

TEST(RosSettings, NamesTheParameterThatIsWrong) {
  XmlRpcValue root = model_parameters();
  root["observations"][0]["vertices"]["noise"] = -1.0;
  expect_input_error([&] { read_model(to_value(root, "parameters of /node"), "/data"); },
                     {"parameters of /node.observations[0].vertices.noise", "-1"});
  root = model_parameters();
  root["colour"] = "red";
  expect_input_error([&] { read_model(to_value(root, "parameters of /node"), "/data"); }, {"colour"});
}

TEST(RosSettings, KeepsTypes) {
  EXPECT_EQ(to_value(XmlRpcValue(true), "p").type(), Value::Type::boolean);
  EXPECT_EQ(to_value(XmlRpcValue(2), "p").type(), Value::Type::number);
  EXPECT_EQ(to_value(XmlRpcValue("-1.5e+3"), "p").as_number(-1e9, 1e9, ""), -1500.0);
  for (const char* text : {"", "-", "e", "mesh.vtk", "1.2.3", "0x10", "nan"}) {
    EXPECT_EQ(to_value(XmlRpcValue(text), "p").type(), Value::Type::text) << text;
  }
  EXPECT_EQ(to_value(XmlRpcValue(), "p").type(), Value::Type::null);
}

}  // namespace
}  // namespace tissue_stiffness
