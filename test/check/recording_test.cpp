// What a recording contradicts: a bar that a force pushes, and the same with one thing wrong at a time.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "../box_model.hpp"
#include "check/check_first_frame.hpp"
#include "check/check_images.hpp"
#include "check/check_motion.hpp"
#include "check/rigid_fit.hpp"
#include "fit/ensemble.hpp"
#include "says.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kNoise = 1e-4, kTruth = 20e3;
constexpr int kFrames = 40;

ModelSettings pushed_bar(const std::string& modulus, const std::string& noise = "1.0e-4",
                         const std::string& kind = "vertices") {
  return box_settings(
      {"inertia: {density: 1000}", "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: " + modulus + "}",
       "fixed: {region: clamp}", "viscous_damping: {beta: 0.01}", "traction: {region: tip, topic: /tool/wrench}"},
      "[{" + kind + ": {topic: /" + kind + ", noise: " + noise + "}}]");
}

const std::string kPrior = "{prior: 30e3, factor: 3}";

class CheckRecording : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 200; ++i) {
      const double t = 0.01 * i;
      Eigen::VectorXd wrench = Eigen::VectorXd::Zero(6);
      wrench.head<3>() << 0.02 * std::sin(4.0 * t), 0.01 * (1.0 - std::cos(5.0 * t)), 0.03 * std::sin(3.0 * t);
      recorded_.loads.push_back({"/tool/wrench", t, wrench});
    }
    record();
  }

  /// Frames of the true bar, of vertices with noise.
  void record() {
    Model truth(pushed_bar(std::to_string(kTruth)), mesh_);
    truth.loads().drive(0.0, recorded_.loads);
    const auto forward = make_forward_model(truth);
    const auto run = forward->start(truth.parameters().theta(truth.parameters().prior_mean()), 0.0);
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0.0, kNoise);
    for (int k = 0; k < kFrames; ++k) {
      Frame frame{0.04 * k, {Observation()}};
      run->advance(frame.time);
      Observation& seen = frame.observations.front();
      seen.time = frame.time;
      seen.ids = Eigen::VectorXi::LinSpaced(mesh_.corner_count, 0, mesh_.corner_count - 1);
      seen.points = mesh_.nodes.leftCols(mesh_.corner_count);
      const Eigen::VectorXd u = run->displacement();
      seen.points += Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, mesh_.corner_count);
      for (Eigen::Index i = 0; i < seen.points.size(); ++i) seen.points.data()[i] += noise(random);
      recorded_.frames.push_back(frame);
    }
  }

  SetupFindings first_frame(const ModelSettings& settings) const {
    return check_first_frame(settings, mesh_, {0.0, recorded_.frames[0], &recorded_.frames[1]});
  }
  void scale_points(double by) {
    for (Frame& frame : recorded_.frames) frame.observations.front().points *= by;
  }
  void scale_force(double by) {
    for (LoadSample& load : recorded_.loads) load.value *= by;
  }
  void move(const Eigen::Isometry3d& motion) {
    for (Frame& frame : recorded_.frames) frame.observations.front().points = motion * frame.observations.front().points;
  }
  /// The same clouds without identities.
  void forget_names() {
    for (Frame& frame : recorded_.frames) {
      frame.observations.front().ids.resize(0);
      frame.observations.front().kind = ObservationKind::points;
    }
  }

  const TetMesh mesh_ = bar_mesh(6, 2, 2);
  Recorded recorded_;
};

TEST_F(CheckRecording, SaysNothingOfARightOne) {
  EXPECT_TRUE(nothing(first_frame(pushed_bar(kPrior))));
  EXPECT_TRUE(nothing(check_motion(pushed_bar(kPrior), mesh_, recorded_)));
  EXPECT_TRUE(nothing(check_motion(pushed_bar("{prior: 7e3, factor: 3}"), mesh_, recorded_)));
}

TEST_F(CheckRecording, NamesCloudsInMillimetres) {
  scale_points(1e3);
  EXPECT_TRUE(says(first_frame(pushed_bar(kPrior)), {"/vertices", "if the cloud is in mm", "1000"}));
  forget_names();
  EXPECT_TRUE(says(first_frame(pushed_bar(kPrior, "1e-4", "points")), {"/points", "if the cloud is in mm"}));
}

TEST_F(CheckRecording, NamesAMeshInMillimetresBesideTheCloud) {
  scale_points(1e-3);
  EXPECT_TRUE(says(first_frame(pushed_bar(kPrior)), {"/vertices", "if the mesh is in mm", "scale: 0.001"}));
}

TEST_F(CheckRecording, NamesTheRigidMotionAfterWhichTheFirstFrameFits) {
  Eigen::Isometry3d motion(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  motion.translation() << 0.02, 0.0, -0.01;
  move(motion);
  EXPECT_TRUE(
      says(first_frame(pushed_bar(kPrior)), {"/vertices", "off the mesh", "times the noise", "turn of 17.", "shift of"}));
  forget_names();
  EXPECT_TRUE(says(first_frame(pushed_bar(kPrior, "1e-4", "points")), {"/points", "off the mesh", "it fits to within"}));
}

TEST_F(CheckRecording, SaysSoWhereNoRigidMotionFits) {
  for (Frame& frame : recorded_.frames) frame.observations.front().points.row(0) *= 2.0;
  EXPECT_TRUE(says(first_frame(pushed_bar(kPrior)), {"/vertices", "off the mesh", "no rigid motion"}));
}

TEST_F(CheckRecording, SaysNothingOfABodyThatStartsInMotion) {
  for (Frame& frame : recorded_.frames) frame.observations.front().points.row(0) *= 2.0;
  ModelSettings model = pushed_bar(kPrior);
  model.effects.emplace_back().name = "initial_motion";
  EXPECT_TRUE(nothing(first_frame(model)));
  EXPECT_TRUE(nothing(check_motion(model, mesh_, recorded_)));
}

TEST_F(CheckRecording, NamesAForceOfTheWrongSign) {
  scale_force(-1.0);
  EXPECT_TRUE(says(check_motion(pushed_bar(kPrior), mesh_, recorded_),
                   {"/tool/wrench", "runs against the force", "scale: -1", "correlation -"}));
}

TEST_F(CheckRecording, NamesAForceInMillinewton) {
  scale_force(1e3);
  EXPECT_TRUE(
      says(check_motion(pushed_bar(kPrior), mesh_, recorded_), {"/tool/wrench", "mN", "scale: 0.001", "of 30 kPa"}));
}

TEST_F(CheckRecording, NamesAPriorInKilopascal) {
  EXPECT_TRUE(
      says(check_motion(pushed_bar("{prior: 30, factor: 3}"), mesh_, recorded_), {"young_modulus", "kPa", "write 30000"}));
}

TEST_F(CheckRecording, NamesANoiseLargerThanTheMotion) {
  EXPECT_TRUE(
      says(check_motion(pushed_bar(kPrior, "0.05"), mesh_, recorded_), {"noise", "50 mm", "larger than the motion"}));
}

TEST_F(CheckRecording, NamesANoiseTenTimesTheResidual) {
  EXPECT_TRUE(says(check_motion(pushed_bar(kPrior, "1.5e-3"), mesh_, recorded_),
                   {"noise", "1.5 mm", "times what the model leaves"}));
}

TEST_F(CheckRecording, NamesANoiseATenthOfTheScatter) {
  EXPECT_TRUE(says(check_motion(pushed_bar(kPrior, "5e-6"), mesh_, recorded_), {"noise", "0.005 mm", "scatter"}));
}

TEST(Scatter, IsThatOfTheNoiseBesideAStrongMode) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.2);
  Eigen::MatrixXd matrix(300, 60);
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      matrix(i, j) = 50.0 * std::sin(0.1 * static_cast<double>(i)) * std::cos(0.3 * static_cast<double>(j)) + noise(random);
    }
  }
  EXPECT_NEAR(scatter(matrix), 0.2, 0.006);
  EXPECT_NEAR(scatter(matrix.transpose()), 0.2, 0.006);
}

TEST(RigidFit, IsTheMotionBack) {
  const Eigen::Matrix3Xd points = bar_mesh().nodes;
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 2) / 3.0);
  const RigidFit fit = fit_pairs(motion * points, points);
  EXPECT_TRUE((fit.motion * motion).isApprox(Eigen::Isometry3d::Identity(), 1e-9));
  EXPECT_LT(fit.rms, 1e-9);
  const RigidFit one = fit_pairs(points.leftCols<1>(), points.col(1));
  EXPECT_TRUE(one.motion.linear().isIdentity());
  EXPECT_LT(one.rms, 1e-12);
}

/// A disc of one grey value on another, with noise.
cv::Mat disc(double body, double background) {
  cv::Mat image(240, 320, CV_32F, cv::Scalar(background)), grain(240, 320, CV_32F);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      if (std::hypot(u - 150, v - 110) < 40) image.at<float>(v, u) = static_cast<float>(body);
    }
  }
  cv::theRNG().state = 5;
  cv::randn(grain, 0.0, 8.0);
  image += grain;
  image.convertTo(image, CV_8U);
  return image;
}

TEST(CheckImages, NameABodyDarkerThanItsBackground) {
  ObservationSettings camera;
  camera.kind = ObservationSettings::Kind::contour;
  camera.topic = "/camera/image_raw";
  EXPECT_TRUE(says(check_images(camera, {disc(60, 180), disc(60, 180)}),
                   {"/camera/image_raw", "darker than its background", "2 of 2"}));
  EXPECT_TRUE(nothing(check_images(camera, {disc(180, 60), disc(60, 180)})));
  EXPECT_TRUE(nothing(check_images(camera, {disc(100, 100)})));
}

}  // namespace
}  // namespace tissue_stiffness
