// Predictions of the sensors without an image are compared with results in closed form.
#include "observation/observation_operator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "../box_model.hpp"
#include "meshing/closest_on_triangle.hpp"
#include "observation/closest_point.hpp"
#include "tangent_check.hpp"

namespace tissue_stiffness {
namespace {

const std::string kVertices = "{vertices: {topic: /v, noise: 2.0e-4}}";
const std::string kMarkers =
    "{markers: {topic: /m, noise: 3.0e-4, rest: [[0.05, 0.007, 0.023], [0.09, 0.02, 0.012], [0.104, 0.011, 0.008]]}}";
const std::string kPoints = "{points: {topic: /p, noise: 4.0e-4}}";

// The fixture holds a body with one sensor and a displacement field.
class Sensor : public testing::Test {
 protected:
  void make(const std::string& law, const std::string& observations) {
    const std::string elasticity = "elasticity: {law: " + law + ", young_modulus: 3.0e4, poisson_ratio: 0.4}";
    model_ = std::make_unique<Model>(box_settings({"inertia: {density: 1000}", elasticity}, observations), bar_mesh());
    sensors_ = make_observation_operators(*model_);
  }
  const TetMesh& mesh() const { return model_->mesh(); }

  // Returns the displacement that takes every node where `place` says.
  Eigen::VectorXd moved(const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& place) const {
    Eigen::VectorXd u(3 * mesh().node_count());
    for (int i = 0; i < mesh().node_count(); ++i) {
      const Eigen::Vector3d x = mesh().nodes.col(i);
      u.segment<3>(3 * i) = place(x) - x;
    }
    return u;
  }
  Eigen::VectorXd at_rest() const { return Eigen::VectorXd::Zero(3 * mesh().node_count()); }

  static Observation seen(const Eigen::Matrix3Xd& points, const Eigen::VectorXi& ids = {}) {
    Observation o;
    o.points = points;
    o.ids = ids;
    return o;
  }

  std::unique_ptr<Model> model_;
  std::vector<std::unique_ptr<ObservationOperator>> sensors_;
};

const Eigen::Matrix3d kTurn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.2, -0.5, 0.7).normalized()).toRotationMatrix();
const Eigen::Vector3d kShift(0.03, -0.04, 0.05);

TEST_F(Sensor, VertexRowsAreTheDisplacedNodes) {
  make("linear", "[" + kVertices + "]");
  const Eigen::VectorXd u = moved([](const Eigen::Vector3d& x) -> Eigen::Vector3d { return 1.5 * x + kShift; });
  Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Constant(3, 2, 0.01);
  points(1, 1) = std::numeric_limits<double>::quiet_NaN();
  const Prediction p = sensors_[0]->predict(seen(points, Eigen::Vector2i(7, 3)), u);
  ASSERT_EQ(p.predicted.size(), 6);
  EXPECT_LT((p.predicted.head<3>() - (1.5 * mesh().nodes.col(7) + kShift)).norm(), 1e-15);
  EXPECT_LT((p.predicted.tail<3>() - (1.5 * mesh().nodes.col(3) + kShift)).norm(), 1e-15);
  EXPECT_EQ(p.sigma, Eigen::VectorXd::Constant(6, 2e-4));
  EXPECT_EQ(p.measured[3], 0.01);
  EXPECT_TRUE(std::isnan(p.measured[4]));
  EXPECT_EQ(p.nodes[0], 7);
  EXPECT_EQ(p.nodes[5], 3);
}

TEST_F(Sensor, VertexThatIsNoCornerIsRefused) {
  make("linear", "[" + kVertices + "]");
  const auto check = [&](int id) {
    return refusal([&] { sensors_[0]->check(seen(Eigen::Vector3d::Zero(), Eigen::VectorXi::Constant(1, id))); });
  };
  EXPECT_EQ(check(mesh().corner_count - 1), "");
  for (const int id : {-1, mesh().corner_count}) {
    EXPECT_NE(check(id).find("/v"), std::string::npos);
    EXPECT_NE(check(id).find(std::to_string(id)), std::string::npos);
    EXPECT_NE(check(id).find("0 to " + std::to_string(mesh().corner_count - 1)), std::string::npos);
  }
}

TEST_F(Sensor, MarkersRideOnAFiniteRotation) {
  make("neo_hookean", "[" + kMarkers + "]");
  const Eigen::Matrix3Xd rest = model_->settings().observations[0].rest;
  const Observation o = seen(rest, Eigen::Vector3i(0, 1, 2));
  const Eigen::VectorXd still = sensors_[0]->predict(o, at_rest()).predicted;
  const Eigen::VectorXd turned =
      sensors_[0]
          ->predict(o, moved([](const Eigen::Vector3d& x) -> Eigen::Vector3d { return kTurn * x + kShift; }))
          .predicted;
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT((still.segment<3>(3 * i) - rest.col(i)).norm(), 1e-15);
    EXPECT_LT((turned.segment<3>(3 * i) - (kTurn * rest.col(i) + kShift)).norm(), 1e-14);
  }
}

TEST_F(Sensor, MarkersStandOffAStretchedSurfaceAsBefore) {
  make("neo_hookean", "[" + kMarkers + "]");
  const Eigen::VectorXd u = moved(
      [](const Eigen::Vector3d& x) -> Eigen::Vector3d { return kTurn * Eigen::Vector3d(1.4, 0.9, 0.8).cwiseProduct(x); });
  const Observation o = seen(Eigen::Vector3d::Zero(), Eigen::VectorXi::Constant(1, 0));
  // The foot (0.05, 0.007, 0.02) moves with the tissue; the pin of 3 mm turns and keeps its length.
  const Eigen::Vector3d expected =
      kTurn * (Eigen::Vector3d(1.4 * 0.05, 0.9 * 0.007, 0.8 * 0.02) + 0.003 * Eigen::Vector3d::UnitZ());
  EXPECT_LT((sensors_[0]->predict(o, u).predicted - expected).norm(), 1e-14);
}

TEST_F(Sensor, MarkersFollowASmallRotationLinearly) {
  make("linear", "[" + kMarkers + "]");
  const Eigen::Vector3d spin(0.01, -0.02, 0.015);
  const Eigen::Matrix3Xd rest = model_->settings().observations[0].rest;
  const Eigen::VectorXd u = moved([&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return x + spin.cross(x); });
  const Prediction p = sensors_[0]->predict(seen(rest, Eigen::Vector3i(2, 0, 1)), u);
  const int order[] = {2, 0, 1};
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d x = rest.col(order[i]);
    EXPECT_LT((p.predicted.segment<3>(3 * i) - (x + spin.cross(x))).norm(), 1e-15);
  }
  const Observation wrong = seen(Eigen::Vector3d::Zero(), Eigen::VectorXi::Constant(1, 3));
  EXPECT_NE(refusal([&] { sensors_[0]->check(wrong); }).find("marker 3"), std::string::npos);
}

TEST_F(Sensor, PointsGiveTheSignedDistanceFromTheDisplacedBox) {
  make("linear", "[" + kPoints + "]");
  // The body is stretched to 0.12 x 0.018 x 0.016 and shifted.
  const Eigen::Vector3d scale(1.2, 0.9, 0.8);
  const Eigen::VectorXd u =
      moved([&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return scale.cwiseProduct(x) + kShift; });
  struct Case {
    Eigen::Vector3d point;  // before the shift
    double outside;         // distance, negative inside
  };
  const std::vector<Case> cases{{{0.050, 0.008, 0.0172}, 0.0012}, {{0.081, 0.005, 0.0151}, -0.0009},
                                {{0.031, -0.002, 0.009}, 0.002},  {{0.1205, 0.008, 0.007}, 0.0005},
                                {{-0.0015, 0.004, 0.01}, 0.0015}, {{0.060, 0.0175, 0.008}, -0.0005},
                                {{0.100, 0.009, 0.0}, 0.0},       {{0.040, 0.018 + 3e-4, 0.016 + 4e-4}, 5e-4}};
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(cases.size()));
  for (std::size_t i = 0; i < cases.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = cases[i].point + kShift;
  const Prediction p = sensors_[0]->predict(seen(points), u);
  ASSERT_EQ(p.predicted.size(), points.cols());
  for (std::size_t i = 0; i + 1 < cases.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(p.measured[k] - p.predicted[k], cases[i].outside, 1e-14) << cases[i].point.transpose();
    EXPECT_EQ(p.sigma[k], 4e-4);
  }
  // Beyond an edge the row is taken along the normal of one of its two faces: it lies outside, and never exceeds the
  // distance.
  const Eigen::Index last = points.cols() - 1;
  EXPECT_GT(p.measured[last] - p.predicted[last], 2.9e-4);
  EXPECT_LE(p.measured[last] - p.predicted[last], 5e-4);
}

TEST_F(Sensor, PointsPullBackTowardsTheSurface) {
  make("linear", "[" + kPoints + "]");
  const Eigen::Vector3d point(0.05, 0.011, 0.021);
  const Prediction p = sensors_[0]->predict(seen(point), at_rest());
  Eigen::VectorXd raised = at_rest();
  for (Eigen::Index i = 2; i < raised.size(); i += 3) raised[i] = 0.0005;
  const Prediction after = sensors_[0]->predict(seen(point), raised);
  EXPECT_NEAR(after.predicted[0] - p.predicted[0], 0.0005, 1e-14);  // h grows as the surface moves along its normal
  EXPECT_NEAR(mesh().nodes(2, p.nodes[0]), 0.02, 1e-12);
}

// The points lie before faces, beyond an edge and beyond a corner.
TEST_F(Sensor, TangentOfPointsIsTheDerivativeOfTheirRows) {
  make("linear", "[" + kPoints + "]");
  const Eigen::VectorXd u = moved([&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return kTurn * x + kShift; });
  Eigen::Matrix3Xd points(3, 4);
  points.col(0) = kTurn * Eigen::Vector3d(0.051, 0.0083, 0.0212) + kShift;
  points.col(1) = kTurn * Eigen::Vector3d(0.082, -0.0013, 0.0112) + kShift;
  points.col(2) = kTurn * Eigen::Vector3d(0.033, 0.0213, 0.0207) + kShift;
  points.col(3) = kTurn * Eigen::Vector3d(0.1008, 0.0205, 0.0211) + kShift;
  expect_tangent(*sensors_[0], seen(points), u);
}

TEST_F(Sensor, RowsOfSeveralSensorsAreJoinedInOrder) {
  make("linear", "[" + kVertices + ", " + kPoints + "]");
  ASSERT_EQ(sensors_.size(), 2U);
  const Prediction a = sensors_[0]->predict(seen(Eigen::Vector3d(1, 2, 3), Eigen::VectorXi::Constant(1, 5)), at_rest());
  const Prediction b = sensors_[1]->predict(seen(Eigen::Vector3d(0.05, 0.01, 0.021)), at_rest());
  const Prediction both = concatenate_predictions({a, b});
  ASSERT_EQ(both.measured.size(), 4);
  EXPECT_EQ(both.measured.head<3>(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(both.predicted[3], b.predicted[0]);
  EXPECT_EQ(both.sigma[3], 4e-4);
  EXPECT_EQ(both.nodes[0], 5);
  EXPECT_EQ(both.places.col(3), Eigen::Vector3d(0.05, 0.01, 0.021));
  EXPECT_EQ(concatenate_predictions({}).measured.size(), 0);
}

TEST(ClosestPoint, OnATriangle) {
  const Eigen::Vector3d a(0, 0, 0), b(2, 0, 0), c(0, 1, 0);
  const auto closest = [&](double x, double y, double z) { return closest_on_triangle({x, y, z}, a, b, c); };
  EXPECT_LT((closest(0.4, 0.3, 5.0) - Eigen::Vector3d(0.4, 0.3, 0)).norm(), 1e-15);  // face
  EXPECT_EQ(closest(-1, -1, 1), a);
  EXPECT_EQ(closest(4, -1, 0), b);
  EXPECT_EQ(closest(-1, 3, 0), c);
  EXPECT_LT((closest(1.5, -2, 3) - Eigen::Vector3d(1.5, 0, 0)).norm(), 1e-15);
  EXPECT_LT((closest(-2, 0.25, 1) - Eigen::Vector3d(0, 0.25, 0)).norm(), 1e-15);
  EXPECT_LT((closest(1.5, 1.5, 0) - Eigen::Vector3d(1, 0.5, 0)).norm(), 1e-15);  // foot on x + 2y = 2
}

TEST(SplitFacets, KeepTheAreaAndTheNormals) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = make_box_mesh({0.3, 0.2, 0.1}, 2, 2, 1, order);
    const SurfaceTriangles triangles = split_facets(mesh);
    EXPECT_EQ(triangles.nodes.cols(), mesh.facet_count() * (order == 2 ? 4 : 1));
    double area = 0.0, volume = 0.0;
    for (Eigen::Index t = 0; t < triangles.nodes.cols(); ++t) {
      const Eigen::Vector3d a = mesh.nodes.col(triangles.nodes(0, t)), b = mesh.nodes.col(triangles.nodes(1, t)),
                            c = mesh.nodes.col(triangles.nodes(2, t)), normal = 0.5 * (b - a).cross(c - a);
      area += normal.norm();
      volume += normal.dot(a) / 3.0;
    }
    EXPECT_NEAR(area, 2.0 * (0.06 + 0.03 + 0.02), 1e-14);
    EXPECT_NEAR(volume, 0.006, 1e-15);
  }
}

}  // namespace
}  // namespace tissue_stiffness
