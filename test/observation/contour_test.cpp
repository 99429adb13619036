// The silhouette and the slice of a box are compared with rectangles that geometry gives.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "../box_model.hpp"
#include "observation/observation_operator.hpp"
#include "observation/outline.hpp"
#include "tangent_check.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string contour(const std::string& more) {
  return "[{contour: {image: /image, camera_info: /info, noise: 1.0e-4" + more + "}}]";
}

Eigen::Isometry3d pose(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z,
                       const Eigen::Vector3d& at) {
  Eigen::Isometry3d t = Eigen::Isometry3d::Identity();
  t.linear().col(0) = x;
  t.linear().col(1) = y;
  t.linear().col(2) = z;
  t.translation() = at;
  return t;
}

// The camera stands half a metre before the face y = 0 of the bar, at the height of its middle, with z up.
Camera pinhole() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 1000.0;
  camera.cx = 320.0;
  camera.cy = 240.0;
  camera.model_from_sensor =
      pose(Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY(), {0.05, -0.5, 0.01});
  return camera;
}

// The image plane cuts the bar at `x`; image x runs along y, and image y along z.
Camera slice_at(double x) {
  Camera camera;
  camera.projection = Camera::Projection::slice;
  camera.width = camera.height = 200;
  camera.fx = camera.fy = 5000.0;  // [pixel/m]
  camera.cx = camera.cy = 40.0;
  camera.model_from_sensor = pose(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), {x, 0, 0});
  return camera;
}

struct Row {
  Eigen::Vector2d point, normal;
  double sigma;
};

class ContourSensor : public testing::Test {
 protected:
  void make(const std::string& observations) {
    model_ = std::make_unique<Model>(
        box_settings({"inertia: {density: 1000}", "elasticity: {law: linear, young_modulus: 3.0e4, poisson_ratio: 0.4}"},
                     observations),
        bar_mesh());
    sensor_ = std::move(make_observation_operators(*model_).front());
  }
  Prediction predict(const Camera& camera, const std::vector<Row>& rows, const Eigen::VectorXd& u) const {
    const Observation o = observed(camera, rows);
    sensor_->check(o);
    return sensor_->predict(o, u);
  }
  static Observation observed(const Camera& camera, const std::vector<Row>& rows) {
    auto outline = std::make_shared<Contour>();
    outline->points.resize(2, static_cast<Eigen::Index>(rows.size()));
    outline->normals.resizeLike(outline->points);
    outline->sigma.resize(outline->points.cols());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      outline->points.col(k) = rows[i].point;
      outline->normals.col(k) = rows[i].normal;
      outline->sigma[k] = rows[i].sigma;
    }
    Observation o;
    o.kind = ObservationKind::contour;
    o.contour = outline;
    o.camera = std::make_shared<Camera>(camera);
    return o;
  }
  Eigen::VectorXd at_rest() const { return Eigen::VectorXd::Zero(model_->fem().dof_count()); }
  Eigen::VectorXd shifted(const Eigen::Vector3d& by) const { return by.replicate(model_->mesh().node_count(), 1); }

  std::unique_ptr<Model> model_;
  std::unique_ptr<ObservationOperator> sensor_;
};

// The camera sees the face y = 0 alone: 0.1 x 0.02 m at a depth of 0.5 m is 200 x 40 pixels about (320, 240).
TEST_F(ContourSensor, SilhouetteOfABoxIsItsFrontFace) {
  make(contour(", projection: silhouette"));
  Observation o;
  o.camera = std::make_shared<Camera>(pinhole());
  const Eigen::Matrix4Xd outline = sensor_->outline(o, at_rest());
  double length = 0.0;
  for (Eigen::Index i = 0; i < outline.cols(); ++i) {
    length += (outline.col(i).head<2>() - outline.col(i).tail<2>()).norm();
    for (const Eigen::Index k : {0, 2}) {
      const double u = std::abs(outline(k, i) - 320.0), v = std::abs(outline(k + 1, i) - 240.0);
      EXPECT_LT(std::abs(std::max(u / 100.0, v / 20.0) - 1.0), 1e-12) << "(" << u << ", " << v << ") is off the rectangle";
    }
  }
  EXPECT_NEAR(length, 2.0 * (200.0 + 40.0), 1e-9);
}

TEST_F(ContourSensor, SilhouetteDistancesAreInMetresAlongTheNormal) {
  make(contour(", projection: silhouette"));
  const Eigen::Vector2d right(1, 0), up(0, -1), oblique = Eigen::Vector2d(1, -1).normalized();
  const std::vector<Row> rows{
      {{423.0, 245.0}, right, 0.3}, {{416.5, 230.0}, right, 0.1},       {{300.0, 218.0}, up, 0.5},
      {{350.0, 262.0}, -up, 0.1},   {{215.0, 240.0}, -right, 1.0},      {{300.0, 222.0}, oblique, 0.1},
      {{423.0, 300.0}, right, 0.1}, {{423.0, 245.0}, right, kInfinity}, {{423.0, 245.0}, -right, 0.1}};
  const Prediction p = predict(pinhole(), rows, at_rest());
  const double scale = 0.5 / 1000.0;  // metres a pixel on the face
  const std::vector<double> outside{3.0, -3.5, 2.0, 2.0, 5.0, -2.0 * std::sqrt(2.0)};
  for (std::size_t i = 0; i < outside.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(p.measured[k] - p.predicted[k], outside[i] * scale, 1e-12) << "row " << i;
    EXPECT_NEAR(p.sigma[k], std::max(1e-4, rows[i].sigma * scale), 1e-12);
    const Eigen::Vector2d back = pinhole().project(p.places.col(k));
    EXPECT_LT((back - rows[i].point).norm(), 1e-9);
  }
  EXPECT_TRUE(std::isnan(p.predicted[6])) << "no outline along the normal";
  EXPECT_TRUE(std::isnan(p.predicted[7])) << "an edge that was not seen";
  // Row 8 faces the opposite side: the left side of the face is 203 pixels behind it, out of reach.
  EXPECT_TRUE(std::isnan(p.predicted[8]));
}

TEST_F(ContourSensor, SilhouetteMovesWithTheBody) {
  make(contour(", projection: silhouette"));
  const std::vector<Row> rows{{{421.0, 240.0}, {1, 0}, 0.1}};
  const double before = predict(pinhole(), rows, at_rest()).predicted[0];
  const double aside = predict(pinhole(), rows, shifted({0.001, 0, 0})).predicted[0];
  EXPECT_NEAR(before, -0.0005, 1e-12);
  EXPECT_NEAR(aside - before, 0.001, 1e-12);
  // At one and a half times the distance the face shrinks to 200/1.5 pixels, of 0.75 mm each.
  const double away = predict(pinhole(), rows, shifted({0, 0.25, 0})).predicted[0];
  EXPECT_NEAR(away, (100.0 / 1.5 - 101.0) * 0.75e-3, 1e-12);
}

// The cameras stand askew before a body that is bent, so that depths and edges differ.
TEST_F(ContourSensor, TangentIsTheDerivativeOfTheRows) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()));
  for (const bool slice : {false, true}) {
    make(contour(slice ? ", projection: slice" : ", projection: silhouette"));
    Eigen::VectorXd u = at_rest();
    for (int i = 0; i < model_->mesh().node_count(); ++i) {
      const Eigen::Vector3d x = model_->mesh().nodes.col(i);
      u.segment<3>(3 * i) = Eigen::Vector3d(0.0, 0.1 * x.x() * x.x(), 0.3 * x.x() * x.x());
    }
    Camera camera = slice ? slice_at(0.053) : pinhole();
    camera.fy = 1.1 * camera.fx;
    camera.model_from_sensor.linear() = camera.model_from_sensor.linear() * turn.toRotationMatrix();
    std::vector<Row> rows;  // beside each piece of the outline, not quite along its normal
    const Eigen::Matrix4Xd outline = sensor_->outline(observed(camera, {}), u);
    for (Eigen::Index i = 0; i < outline.cols(); ++i) {
      const Eigen::Vector2d edge = (outline.col(i).tail<2>() - outline.col(i).head<2>()).normalized();
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector2d normal = (side * Eigen::Vector2d(edge.y(), -edge.x()) + 0.1 * edge).normalized();
        const Row row{0.6 * outline.col(i).head<2>() + 0.4 * outline.col(i).tail<2>() - 0.2 * normal, normal, 1.0};
        if (std::isfinite(predict(camera, {row}, u).predicted[0])) rows.push_back(row);
      }
    }
    ASSERT_GE(rows.size(), 8U);
    expect_tangent(*sensor_, observed(camera, rows), u);
  }
}

TEST_F(ContourSensor, NothingIsPredictedBehindTheCamera) {
  make(contour(", projection: silhouette"));
  const std::vector<Row> rows{{{421.0, 240.0}, {1, 0}, 0.1}};
  EXPECT_TRUE(std::isnan(predict(pinhole(), rows, shifted({0, -2.0, 0})).predicted[0]));
}

TEST_F(ContourSensor, SliceOfABoxIsItsCrossSection) {
  make(contour(", projection: slice"));
  // The section is stretched by 1.5 across: it becomes 0.03 x 0.02 m, 150 x 100 pixels from (40, 40).
  Eigen::VectorXd u = at_rest();
  for (int i = 0; i < model_->mesh().node_count(); ++i) u[3 * i + 1] = 0.5 * model_->mesh().nodes(1, i);
  const std::vector<Row> rows{{{193.0, 60.0}, {1, 0}, 0.2}, {{100.0, 137.0}, {0, 1}, 2.0}, {{44.0, 99.0}, {-1, 0}, 0.2},
                              {{70.0, 38.0}, {0, -1}, 0.2}, {{300.0, 60.0}, {1, 0}, 0.2},  {{193.0, 300.0}, {1, 0}, 0.2}};
  const Prediction p = predict(slice_at(0.034), rows, u);
  const double scale = 1.0 / 5000.0;
  const std::vector<double> outside{3.0, -3.0, -4.0, 2.0};
  for (std::size_t i = 0; i < outside.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(p.measured[k] - p.predicted[k], outside[i] * scale, 1e-12) << "row " << i;
    EXPECT_NEAR(p.sigma[k], std::max(1e-4, rows[i].sigma * scale), 1e-15);
    const Eigen::Vector3d place(0.034, (rows[i].point.x() - 40.0) * scale, (rows[i].point.y() - 40.0) * scale);
    EXPECT_LT((p.places.col(k) - place).norm(), 1e-12);
  }
  EXPECT_NEAR(p.measured[4] - p.predicted[4], 110.0 * scale, 1e-12);  // within reach: a quarter of the body's size
  EXPECT_TRUE(std::isnan(p.predicted[5]));
}

TEST_F(ContourSensor, SliceBesideTheBodySeesNothing) {
  make(contour(", projection: slice"));
  const std::vector<Row> rows{{{193.0, 60.0}, {1, 0}, 0.2}};
  EXPECT_TRUE(std::isnan(predict(slice_at(0.13), rows, at_rest()).predicted[0]));
}

TEST_F(ContourSensor, NormalsOfACavityPointIntoTheTissue) {
  make(contour(", projection: slice, segmentation: {kind: cavity}"));
  // The bar's skin is taken for the wall of a cavity, so its outward normals point into the cavity.
  const std::vector<Row> rows{{{143.0, 60.0}, {-1, 0}, 0.2}, {{143.0, 60.0}, {1, 0}, 0.2}};
  const Prediction p = predict(slice_at(0.034), rows, at_rest());
  EXPECT_NEAR(p.predicted[0], 3.0 / 5000.0, 1e-12);
  EXPECT_GT(std::abs(p.predicted[1]), 90.0 / 5000.0);  // the side across the section
}

TEST_F(ContourSensor, OnlyTheRegionIsSeen) {
  make(contour(", projection: slice, region: top"));
  const std::vector<Row> rows{{{60.0, 141.0}, {0, 1}, 0.2}, {{60.0, 38.0}, {0, -1}, 0.2}};
  const Prediction p = predict(slice_at(0.034), rows, at_rest());
  EXPECT_NEAR(p.predicted[0], -1.0 / 5000.0, 1e-12);
  EXPECT_TRUE(std::isnan(p.predicted[1]));
}

TEST_F(ContourSensor, AContourNeedsItsCamera) {
  make(contour(""));
  Observation o;
  o.contour = std::make_shared<Contour>();
  EXPECT_NE(refusal([&] { sensor_->check(o); }).find("CameraInfo"), std::string::npos);
}

TEST(Outline, AnEdgeBelongsToTwoTriangles) {
  const TetMesh mesh = make_box_mesh({1, 1, 1}, 2, 2, 2, 2);
  const std::vector<SurfaceEdge> edges = surface_edges(split_facets(mesh));
  EXPECT_EQ(edges.size(), static_cast<std::size_t>(mesh.facet_count() * 4 * 3 / 2));
  for (const SurfaceEdge& edge : edges) EXPECT_GE(edge.right, 0);
}

}  // namespace
}  // namespace tissue_stiffness
