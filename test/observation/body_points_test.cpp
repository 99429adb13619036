#include "observation/body_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "meshing/box_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kNoise = 5e-4;

/// A block of 10 x 4 x 4 cm on a table at z = 0.
class BodyPointsTest : public ::testing::Test {
 protected:
  void add(double x, double y, double z) { points_.emplace_back(x, y, z); }
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  double noise() { return std::normal_distribution<double>(0.0, kNoise)(random_); }

  /// The block's top and front side.
  void add_body(int count) {
    for (int i = 0; i < count; ++i) {
      if (i % 2 == 0) {
        add(0.1 * unit(), 0.04 * unit(), 0.04 + noise());
      } else {
        add(0.1 * unit(), noise(), 0.04 * unit());
      }
    }
  }
  void add_table(int count) {
    for (int i = 0; i < count; ++i) {
      const double x = 0.5 * unit() - 0.2, y = 0.4 * unit() - 0.2;
      if (x < 0.0 || x > 0.1 || y < 0.0 || y > 0.04) add(x, y, noise());
    }
  }

  Eigen::Matrix3Xd select(const DepthCameraSettings& settings) const {
    const Eigen::Map<const Eigen::Matrix3Xd> points(points_.front().data(), 3, static_cast<Eigen::Index>(points_.size()));
    return BodyPoints(settings, kNoise, make_box_mesh({0.1, 0.04, 0.04}, 5, 2, 2)).select(points);
  }

  std::mt19937 random_{3};
  std::vector<Eigen::Vector3d> points_;
  const DepthCameraSettings settings_{0.02, 0.003, 4};
};

double distance_to_block(const Eigen::Vector3d& p) {
  return std::min(std::abs(p.z() - 0.04), std::abs(p.y()));
}

TEST_F(BodyPointsTest, LeavesTheBodyOfACrowdedScene) {
  add_body(20000);
  add_table(40000);
  for (int i = 0; i < 2000; ++i) add(0.5 * unit() - 0.2, 0.25, 0.4 * unit());                          // a wall
  for (int i = 0; i < 60; ++i) add(0.14 * unit() - 0.02, 0.08 * unit() - 0.02, 0.05 + 0.01 * unit());  // flying pixels
  add(std::nan(""), 0.0, 0.0);
  add(0.05, 0.02, std::numeric_limits<double>::infinity());
  const Eigen::Matrix3Xd body = select(settings_);
  EXPECT_GT(body.cols(), 500);
  EXPECT_LT(body.cols(), 3000);
  double top = 0.0;
  int far = 0, on_top = 0;
  for (Eigen::Index i = 0; i < body.cols(); ++i) {
    far += distance_to_block(body.col(i)) > 4.0 * kNoise;
    EXPECT_GT(body(2, i), 3.0 * kNoise - 1e-6) << "a point of the table";
    if (body(1, i) > 0.003) top += body(2, i), ++on_top;
  }
  EXPECT_LT(far, 0.01 * static_cast<double>(body.cols()));
  EXPECT_NEAR(top / on_top, 0.04, 5e-5) << "thinning moves the surface";
}

// Of a table alone that lies within the margin, nothing is left.
TEST_F(BodyPointsTest, TableWithoutTheBodyIsNoBody) {
  add_table(40000);
  EXPECT_EQ(select(settings_).cols(), 0);
}

// The body's own flat top is no table: planes are looked for outside the box alone.
TEST_F(BodyPointsTest, FlatTopIsKept) {
  add_body(20000);
  const Eigen::Index without = select(settings_).cols();
  EXPECT_GT(without, 1000);
}

// A plane that cuts through the body cannot be what it lies on.
TEST_F(BodyPointsTest, PlaneThroughTheBodyIsNotBelieved) {
  add_body(20000);
  const Eigen::Index alone = select(settings_).cols();
  for (int i = 0; i < 20000; ++i) {
    const double x = 0.5 * unit() - 0.2, y = 0.4 * unit() - 0.2;
    if (x < -0.03 || x > 0.13) add(x, y, 0.02 + noise());
  }
  EXPECT_GT(static_cast<double>(select(settings_).cols()), 0.95 * static_cast<double>(alone));
}

TEST_F(BodyPointsTest, MarginIsTheLargestDistanceFromTheMesh) {
  add_body(20000);
  for (int i = 0; i < 3000; ++i) add(0.1 * unit(), 0.04 * unit(), 0.07 + noise());  // a hand
  const auto highest = [&](double margin) { return select({margin, 0.003, 4}).row(2).maxCoeff(); };
  EXPECT_LT(highest(0.02), 0.045);
  EXPECT_GT(highest(0.04), 0.065);
}

TEST_F(BodyPointsTest, VoxelsAndNeighboursThinTheCloud) {
  add_body(20000);
  for (int i = 0; i < 200; ++i) add(0.1 * unit(), 0.04 * unit(), 0.05 + 0.008 * unit());  // flying pixels
  EXPECT_GT(select({0.02, 0.003, 4}).cols(), 3 * select({0.02, 0.006, 4}).cols());
  EXPECT_LT(select({0.02, 0.003, 4}).row(2).maxCoeff(), 0.045);
  EXPECT_GT(select({0.02, 0.003, 0}).row(2).maxCoeff(), 0.05);
  const Eigen::Index chosen = select({0.02, 0.0, 4}).cols();  // 1/25 of the size: 4.6 mm
  EXPECT_LT(chosen, select({0.02, 0.003, 4}).cols());
  EXPECT_GT(chosen, 200);
}

TEST_F(BodyPointsTest, TooManyVoxelsAreAnInputError) {
  add_body(10);
  EXPECT_THROW(select({1.0, 1e-4, 4}), InputError);
}

TEST_F(BodyPointsTest, ObservationWithoutTheBodyNamesItsTopic) {
  ModelSettings settings;
  settings.observations.resize(2);
  settings.observations[0].kind = settings.observations[1].kind = ObservationKind::points;
  settings.observations[1].topic = "/depth/points";
  settings.observations[1].noise = kNoise;
  settings.observations[1].depth_camera = settings_;
  const auto body_points = make_body_points(settings, make_box_mesh({0.1, 0.04, 0.04}, 5, 2, 2));
  Observation observation;
  observation.points = Eigen::Matrix3Xd::Constant(3, 7, 5.0);
  select_body(body_points, settings, &observation);
  EXPECT_EQ(observation.points.cols(), 7) << "the first observation is no depth camera";
  observation.source = 1;
  try {
    select_body(body_points, settings, &observation);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/depth/points"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("7 points"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tissue_stiffness
