// In recordings of a bar with something hidden, the force that the model lacks is that of what was hidden.
#include "diagnosis/missing_force.hpp"

#include <gtest/gtest.h>

#include "../estimation/bar.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kModulus = 20e3, kMass = 1000.0 * 0.10 * 0.02 * 0.02;

/// Returns the force that a bar of the right modulus lacks in a recording of one with `hidden`.
MissingForce lacking(const std::vector<std::string>& hidden) {
  std::vector<std::string> effects = bar_under_gravity("{prior: 20.0e3, factor: 3}");
  effects.insert(effects.end(), hidden.begin(), hidden.end());
  const Experiment experiment(box_settings(effects), bar_mesh(), {kModulus});
  Recording recording;
  recording.frames = see_all(experiment, experiment.film(0.0, 0.02, 60), kNoise, 1);
  const RecordingFit recording_fit(box_settings(bar_under_gravity("{prior: 20.0e3, factor: 3}")), bar_mesh(), recording);
  return missing_force(recording_fit, recording_fit.model().parameters().prior_mean());
}

TEST(MissingForce, IsNoneWhereNothingIsMissing) {
  const MissingForce force = lacking({});
  EXPECT_TRUE(force.time.empty()) << force.words;
}

// A push of 0.4 N/kg acts everywhere: the modes feel what the clamp does not carry of it.
TEST(MissingForce, IsTheWeightThatIsMissing) {
  const MissingForce force = lacking({"gravity: {acceleration: [0, 0.4, 0]}"});
  ASSERT_EQ(force.time.size(), 59U) << "intervals between frames";
  EXPECT_GT(force.explained, 0.95);
  EXPECT_GT(force.follows.at("constant"), 0.95);
  EXPECT_NEAR(force.total[30].y() / (0.4 * kMass), 0.9, 0.1) << "less what the clamped end bears";
  EXPECT_LT(std::abs(force.total[30].z()), 0.05 * force.total[30].y());
}

TEST(MissingForce, FollowsTheVelocityWhereDampingIsMissing) {
  const MissingForce force = lacking({"viscous_damping: {beta: 6.0e-3}"});
  ASSERT_EQ(force.time.size(), 59U) << "intervals between frames";
  EXPECT_GT(force.follows.at("velocity"), 0.8);
  EXPECT_GT(force.follows.at("velocity"), 2.0 * force.follows.at("displacement"));
  EXPECT_NE(force.words.find("follows the velocity"), std::string::npos) << force.words;
}

// Nothing else holds the free end, where a spring is missing.
TEST(MissingForce, IsWhereASpringIsMissing) {
  const MissingForce force = lacking({"foundation: {region: tip, stiffness: 3.0e3}"});
  ASSERT_EQ(force.time.size(), 59U) << "intervals between frames";
  EXPECT_GT(force.follows.at("displacement"), 0.8) << force.words;
  const TetMesh mesh = bar_mesh();
  double tip = 0.0, middle = 0.0;
  for (std::size_t i = 0; i < force.nodes.size(); ++i) {
    const double x = mesh.nodes(0, force.nodes[i]);
    for (const Eigen::Matrix3Xd& at : force.at_nodes) {
      const double square = at.col(static_cast<Eigen::Index>(i)).squaredNorm();
      if (x > 0.09) tip = std::max(tip, square);
      if (x > 0.03 && x < 0.06) middle = std::max(middle, square);
    }
  }
  EXPECT_GT(tip, 4.0 * middle);
}

}  // namespace
}  // namespace tissue_stiffness
