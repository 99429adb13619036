// Effects of the observation change what sensors make of a motion.
#include <gtest/gtest.h>

#include <cmath>

#include "../box_model.hpp"
#include "fit/ensemble.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {
namespace {

const std::vector<std::string> kBar{"inertia: {density: 1000}",
                                    "elasticity: {law: linear, young_modulus: 3.0e4, poisson_ratio: 0.4}",
                                    "fixed: {region: clamp}", "gravity: {acceleration: [0.5, 1, -2]}"};
const std::string kSensors = "[{vertices: {topic: /vertices, noise: 1.0e-4}}, {points: {topic: /points, noise: 1.0e-4}}]";
constexpr double kLate = 0.1;  // [s]

// Returns two corners of the bar and a point above its top, seen at one instant.
Frame frame(const TetMesh& mesh) {
  Frame f;
  f.time = kLate;
  Observation vertices;
  vertices.time = kLate;
  vertices.ids = Eigen::Vector2i(0, mesh.corner_count - 1);
  vertices.points = Eigen::Matrix3Xd::Zero(3, 2);
  Observation above;
  above.source = 1;
  above.kind = ObservationKind::points;
  above.time = kLate;
  above.points = Eigen::Vector3d(0.05, 0.01, 0.021);
  f.observations = {vertices, above};
  return f;
}

struct Seen {
  Eigen::Matrix3Xd vertices;
  double height;  // of the model's surface over the point
};

Seen seen(const TetMesh& mesh, const std::string& effect, bool moving) {
  std::vector<std::string> effects = kBar;
  if (!effect.empty()) effects.push_back(effect);
  const Model model(box_settings(effects, kSensors), mesh);
  const auto sensors = make_observation_operators(model);
  const ReducedModel runs(model);
  Ensemble ensemble(model, runs, sensors);
  ensemble.restart(Eigen::MatrixXd::Zero(0, 1), {0.0});
  ensemble.advance(moving ? kLate : -1.0);
  const Eigen::VectorXd h = ensemble.predict(frame(mesh)).central.predicted;
  return {Eigen::Map<const Eigen::Matrix3Xd>(h.data(), 3, 2), h[6]};
}

TEST(SeenMotion, IsScaledAboutTheOrigin) {
  const TetMesh mesh = bar_mesh();
  const Seen plain = seen(mesh, "", true), scaled = seen(mesh, "image_scale: {ratio: 1.06}", true);
  EXPECT_LT((scaled.vertices - 1.06 * plain.vertices).norm(), 1e-12);
}

TEST(SeenMotion, LagsBehind) {
  const TetMesh mesh = bar_mesh();
  const Seen late = seen(mesh, "time_offset: {offset: 0.1}", true), rest = seen(mesh, "", false);
  EXPECT_EQ(late.vertices, rest.vertices);
  EXPECT_NE(seen(mesh, "time_offset: {offset: 0.05}", true).vertices, rest.vertices);
}

TEST(SeenMotion, DriftsRigidly) {
  const TetMesh mesh = bar_mesh();
  const Seen plain = seen(mesh, "", true),
             drift = seen(mesh, "rigid_drift: {velocity: [0.02, 0, 0.01], rotation: [0, 0, 5]}", true);
  const double angle = 5.0 * kLate;
  Eigen::Matrix3d turn;
  turn << std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1;
  const Eigen::Matrix3Xd expected = (turn * plain.vertices).colwise() + kLate * Eigen::Vector3d(0.02, 0, 0.01);
  EXPECT_LT((drift.vertices - expected).norm(), 1e-12);
}

TEST(SeenMotion, IsTurnedAboutWhereEachPointWasAtRest) {
  const TetMesh mesh = bar_mesh();
  const Seen rest = seen(mesh, "", false), plain = seen(mesh, "", true),
             turned = seen(mesh, "sensor_rotation: {angles: [0, 0.3, 0]}", true);
  Eigen::Matrix3d turn;
  turn << std::cos(0.3), 0, std::sin(0.3), 0, 1, 0, -std::sin(0.3), 0, std::cos(0.3);
  EXPECT_GT((plain.vertices - rest.vertices).norm(), 1e-6);
  EXPECT_LT((turned.vertices - rest.vertices - turn * (plain.vertices - rest.vertices)).norm(), 1e-12);
}

// A point 1 mm above the surface lies on it for a sensor that measures 1 mm outside; tracked vertices have no such bias.
TEST(SeenMotion, LiesOutsideTheSurface) {
  const TetMesh mesh = bar_mesh();
  const Seen plain = seen(mesh, "", false), biased = seen(mesh, "contour_bias: {bias: 0.001}", false);
  EXPECT_NEAR(plain.height, -0.001, 1e-9);
  EXPECT_NEAR(biased.height, 0.0, 1e-9);
  EXPECT_EQ(plain.vertices, biased.vertices);
}

}  // namespace
}  // namespace tissue_stiffness
