// Features of the surface that a camera sees are compared with results in closed form.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "../box_model.hpp"
#include "observation/closest_point.hpp"
#include "observation/feature_anchors.hpp"
#include "observation/observation_operator.hpp"
#include "observation/predict_frame.hpp"
#include "tangent_check.hpp"

namespace tissue_stiffness {
namespace {

const std::string kTracks = "[{tracks: {image: /image, camera_info: /info, noise: 1.0e-5}}]";

// A camera above the bar, turned and beside its middle.
Camera camera_above() {
  Camera out;
  out.width = 640;
  out.height = 480;
  out.fx = 900.0;
  out.fy = 880.0;
  out.cx = 320.0;
  out.cy = 235.0;
  const Eigen::Vector3d place(0.06, 0.0, 0.17), target(0.05, 0.01, 0.02);
  out.model_from_sensor.translation() = place;
  const Eigen::Vector3d z = (target - place).normalized(),
                        x = Eigen::Vector3d(1.0, 0.2, 0.0).cross(z).cross(z).normalized();
  out.model_from_sensor.linear() << -x, z.cross(-x), z;
  return out;
}

class Tracks : public testing::Test {
 protected:
  void make(const std::vector<std::string>& more = {}, const TetMesh& mesh = bar_mesh()) {
    std::vector<std::string> effects{"inertia: {density: 1000}",
                                     "elasticity: {law: linear, young_modulus: 3.0e4, poisson_ratio: 0.4}"};
    effects.insert(effects.end(), more.begin(), more.end());
    model_ = std::make_unique<Model>(box_settings(effects, kTracks), mesh);
    sensors_ = make_observation_operators(*model_);
  }

  // Returns tracks of features at these places of the surface, which `place` moves.
  FeatureTracks tracks_of(const Eigen::Matrix3Xd& rest,
                          const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& place) const {
    FeatureTracks out;
    out.stamp = 7.0;
    out.width = camera_.width;
    out.height = camera_.height;
    out.ids = Eigen::VectorXi::LinSpaced(rest.cols(), 10, 10 + static_cast<int>(rest.cols()) - 1);
    out.pixels.resize(2, rest.cols());
    out.reference.resize(2, rest.cols());
    out.sigma = Eigen::VectorXd::LinSpaced(rest.cols(), 0.1, 0.3);
    out.windows = Eigen::VectorXd::Zero(rest.cols());
    for (Eigen::Index i = 0; i < rest.cols(); ++i) {
      out.reference.col(i) = camera_.project(rest.col(i));
      out.pixels.col(i) = camera_.project(place(rest.col(i)));
    }
    return out;
  }

  Eigen::VectorXd moved(const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& place) const {
    const TetMesh& mesh = model_->mesh();
    Eigen::VectorXd u(3 * mesh.node_count());
    for (int i = 0; i < mesh.node_count(); ++i) u.segment<3>(3 * i) = place(mesh.nodes.col(i)) - mesh.nodes.col(i);
    return u;
  }

  static Eigen::Matrix3Xd on_top() {
    Eigen::Matrix3Xd out(3, 12);
    for (int i = 0; i < 12; ++i) out.col(i) << 0.013 + 0.007 * i, 0.004 + 0.004 * (i % 4), 0.02;
    return out;
  }

  const Camera camera_ = camera_above();
  std::unique_ptr<Model> model_;
  std::vector<std::unique_ptr<ObservationOperator>> sensors_;
};

Eigen::Vector3d stretched(const Eigen::Vector3d& x) {
  return Eigen::Vector3d(1.03 * x.x() + 0.1 * x.z(), 0.97 * x.y() - 0.05 * x.x(), x.z() + 0.06 * x.x()) +
         Eigen::Vector3d(0.001, -0.002, 0.0015);
}

TEST_F(Tracks, RaysMeetTheSurfaceThatFacesThem) {
  const TetMesh mesh = bar_mesh();
  const SurfacePoint top = first_surface_point(mesh, {0.031, 0.012, 0.3}, -Eigen::Vector3d::UnitZ());
  ASSERT_GE(top.facet, 0);
  EXPECT_LT((top.point - Eigen::Vector3d(0.031, 0.012, 0.02)).norm(), 1e-12);
  EXPECT_LT((top.normal - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_NEAR(top.distance, 0.28, 1e-12);
  EXPECT_LT(first_surface_point(mesh, {0.031, 0.022, 0.3}, -Eigen::Vector3d::UnitZ()).facet, 0);
  EXPECT_LT(first_surface_point(mesh, {0.031, 0.012, 0.3}, Eigen::Vector3d::UnitZ()).facet, 0) << "behind the eye";
}

TEST_F(Tracks, FeaturesAreWhereTheirRaysMeetTheBodyAtRest) {
  make();
  FeatureAnchors anchors(model_->mesh());
  const Eigen::Matrix3Xd rest = on_top();
  const Observation o = anchors.observe(tracks_of(rest, stretched), camera_, 0, "/image");
  ASSERT_EQ(o.points.cols(), rest.cols());
  EXPECT_LT((o.points - rest).colwise().norm().maxCoeff(), 1e-9);
  EXPECT_EQ(o.kind, ObservationKind::tracks);
  EXPECT_EQ(o.row_count(), 2 * rest.cols());
  EXPECT_EQ(o.ids[3], 13);
  EXPECT_EQ(o.time, 7.0);
}

TEST_F(Tracks, WhatIsNotTheBodysIsLeftOut) {
  make();
  FeatureAnchors anchors(model_->mesh());
  Eigen::Matrix3Xd rest = on_top();
  rest.col(2) << 0.05, 0.05, 0.02;   // beside the bar
  rest.col(5) << 0.05, 0.019, 0.02;  // its window goes on beyond the edge
  FeatureTracks tracks = tracks_of(rest, stretched);
  tracks.windows.setConstant(10.0);                      // 1.7 mm
  tracks.pixels.col(8) += Eigen::Vector2d(60.0, -80.0);  // mistaken for another
  const Observation o = anchors.observe(tracks, camera_, 0, "/image");
  std::vector<int> ids(o.ids.data(), o.ids.data() + o.ids.size());
  for (const int id : {12, 15, 18}) EXPECT_EQ(std::count(ids.begin(), ids.end(), id), 0) << id;
  EXPECT_EQ(ids.size(), 9u);
  const Eigen::Matrix3Xd away = rest.colwise() + Eigen::Vector3d(0.0, 0.2, 0.0);
  const std::string told = refusal([&] { anchors.observe(tracks_of(away, stretched), camera_, 0, "/image"); });
  EXPECT_NE(told.find("/image"), std::string::npos);
  EXPECT_NE(told.find("12 features, none of which is the body's"), std::string::npos);
}

// A recording that starts again has another reference.
TEST_F(Tracks, AFeatureOfAnotherReferenceIsPlacedAnew) {
  make();
  FeatureAnchors anchors(model_->mesh());
  const Eigen::Matrix3Xd rest = on_top(), other = rest.colwise() + Eigen::Vector3d(0.002, 0.0, 0.0);
  anchors.observe(tracks_of(rest, stretched), camera_, 0, "/image");
  const Observation o = anchors.observe(tracks_of(other, stretched), camera_, 0, "/image");
  EXPECT_LT((o.points - other).colwise().norm().maxCoeff(), 1e-9);
}

TEST_F(Tracks, RowsAreThePixelsMotionInMetres) {
  make();
  FeatureAnchors anchors(model_->mesh());
  const Eigen::Matrix3Xd rest = on_top();
  const Observation o = anchors.observe(tracks_of(rest, stretched), camera_, 0, "/image");
  const Prediction p = sensors_[0]->predict(o, moved(stretched));
  ASSERT_EQ(p.predicted.size(), 24);
  EXPECT_LT((p.predicted - p.measured).cwiseAbs().maxCoeff(), 1e-9) << "an affine motion is that of the elements";
  for (int i = 0; i < 12; ++i) {
    const double depth = (camera_.model_from_sensor.inverse() * rest.col(i)).z();
    const Eigen::Vector2d pixels = camera_.project(stretched(rest.col(i))) - camera_.project(rest.col(i));
    EXPECT_NEAR(p.measured[2 * i], depth / 900.0 * pixels.x(), 1e-12);
    EXPECT_NEAR(p.measured[2 * i + 1], depth / 880.0 * pixels.y(), 1e-12);
    EXPECT_NEAR(p.sigma[2 * i], std::max(1e-5, o.tracks->sigma[i] * depth / 900.0), 1e-12);
    EXPECT_LT((camera_.project(p.places.col(2 * i + 1)) - o.tracks->pixels.col(i)).norm(), 1e-9);
  }
  EXPECT_GT(p.measured.cwiseAbs().maxCoeff(), 1e-3);
  const Eigen::Matrix4Xd displaced = sensors_[0]->outline(o, moved(stretched));
  EXPECT_LT((displaced.topRows<2>() - o.tracks->reference).norm(), 1e-9);
  EXPECT_LT((displaced.bottomRows<2>() - o.tracks->pixels).norm(), 1e-9);
  EXPECT_EQ(sensors_[0]->predict(o, Eigen::VectorXd::Zero(3 * model_->mesh().node_count())).predicted.norm(), 0.0);
}

// A camera that moves sees the features elsewhere. They are the points that the first image showed.
TEST_F(Tracks, FeaturesStayWhileTheCameraMoves) {
  make();
  FeatureAnchors anchors(model_->mesh());
  const Eigen::Matrix3Xd rest = on_top();
  FeatureTracks tracks = tracks_of(rest, stretched);
  anchors.observe(tracks, camera_, 0, "/image");
  Camera later = camera_;
  later.model_from_sensor = Eigen::Translation3d(0.01, -0.02, 0.03) * camera_.model_from_sensor *
                            Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ());
  for (Eigen::Index i = 0; i < rest.cols(); ++i) tracks.pixels.col(i) = later.project(stretched(rest.col(i)));
  const Observation o = anchors.observe(tracks, later, 0, "/image");
  ASSERT_EQ(o.points.cols(), rest.cols());
  EXPECT_LT((o.points - rest).colwise().norm().maxCoeff(), 1e-9);
  const Prediction p = sensors_[0]->predict(o, moved(stretched));
  EXPECT_LT((p.predicted - p.measured).cwiseAbs().maxCoeff(), 1e-9);
}

TEST_F(Tracks, TangentAgreesWithDifferences) {
  make();
  FeatureAnchors anchors(model_->mesh());
  const Observation o = anchors.observe(tracks_of(on_top(), stretched), camera_, 0, "/image");
  expect_tangent(*sensors_[0], o, moved(stretched));
}

// Another mesh carries the same places.
TEST_F(Tracks, AFinerMeshPredictsTheSame) {
  make();
  FeatureAnchors anchors(model_->mesh());
  const Observation o = anchors.observe(tracks_of(on_top(), stretched), camera_, 0, "/image");
  const Eigen::VectorXd coarse = sensors_[0]->predict(o, moved(stretched)).predicted;
  make({}, bar_mesh(8, 2, 2));
  EXPECT_LT((sensors_[0]->predict(o, moved(stretched)).predicted - coarse).norm(), 1e-12);
}

// The camera is somewhere else than tf says. The features at rest are seen as they are; their motion looks otherwise.
TEST_F(Tracks, PoseTangentIsThatOfTheMotionAlone) {
  make();
  FeatureAnchors anchors(model_->mesh());
  const Observation o = anchors.observe(tracks_of(on_top(), stretched), camera_, 0, "/image");
  const Eigen::VectorXd u = moved(stretched);
  const std::optional<Eigen::MatrixXd> tangent = sensors_[0]->pose_tangent(o, u);
  ASSERT_TRUE(tangent);
  const Eigen::Vector3d middle = model_->mesh().nodes.rowwise().mean();
  constexpr double step = 1e-5;
  for (int axis = 0; axis < 6; ++axis) {
    const auto seen = [&](double by) {
      Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
      if (axis < 3) {
        motion.translation()[axis] = by;
      } else {
        motion = Eigen::Translation3d(middle) * Eigen::AngleAxisd(by, Eigen::Vector3d::Unit(axis - 3)) *
                 Eigen::Translation3d(-middle);
      }
      Eigen::VectorXd out(24);
      for (int i = 0; i < 12; ++i) {
        const Eigen::Vector3d rest = o.points.col(i);
        const double depth = (camera_.model_from_sensor.inverse() * rest).z();
        out.segment<2>(2 * i) =
            Eigen::Vector2d(depth / 900.0, depth / 880.0)
                .cwiseProduct(camera_.project(motion * stretched(rest)) - camera_.project(motion * rest));
      }
      return out;
    };
    const Eigen::VectorXd differences = (seen(step) - seen(-step)) / (2.0 * step);
    EXPECT_LT((tangent->col(axis) - differences).cwiseAbs().maxCoeff(), 1e-6) << axis;
    EXPECT_GT(differences.cwiseAbs().maxCoeff(), 1e-5) << axis;
  }
}

// A scale that is wrong enlarges the motion. At rest the features are where the reference shows them.
TEST_F(Tracks, SensorsThatErrAtRestShowTheMotionAlone) {
  make({"image_scale: {ratio: 1.1}"});
  FeatureAnchors anchors(model_->mesh());
  Frame frame;
  frame.observations = {anchors.observe(tracks_of(on_top(), stretched), camera_, 0, "/image")};
  const Eigen::VectorXd theta = model_->parameters().theta(Eigen::VectorXd(0)), u = moved(stretched);
  const Eigen::VectorXd still = predict_frame(*model_, sensors_, frame, theta, 0.0 * u).predicted;
  EXPECT_LT(still.norm(), 1e-15);
  const Eigen::VectorXd enlarged = predict_frame(*model_, sensors_, frame, theta, u).predicted;
  EXPECT_LT((enlarged - sensors_[0]->predict(frame.observations[0], 1.1 * u).predicted).norm(), 1e-12);
  const Eigen::MatrixXd along = predict_along(*model_, sensors_, frame, theta, u, u);
  const double step = 1e-6;
  const Eigen::VectorXd differences = (predict_frame(*model_, sensors_, frame, theta, (1.0 + step) * u).predicted -
                                       predict_frame(*model_, sensors_, frame, theta, (1.0 - step) * u).predicted) /
                                      (2.0 * step);
  EXPECT_LT((along.col(0) - differences).norm(), 1e-4 * differences.norm());
}

}  // namespace
}  // namespace tissue_stiffness
