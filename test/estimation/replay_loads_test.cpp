#include "estimation/replay_loads.hpp"

#include <gtest/gtest.h>

#include "bar.hpp"

namespace tissue_stiffness {
namespace {

LoadSample sample(const std::string& topic, double time, const std::vector<double>& value) {
  return {topic, time, Eigen::Map<const Eigen::VectorXd>(value.data(), static_cast<Eigen::Index>(value.size()))};
}

TEST(ReplayLoads, AreTheMeasuredForceInTheMiddleOfItsRegion) {
  Model model(box_settings({"inertia: {density: 1000}", modulus("1e4"), "fixed: {region: clamp}",
                            "traction: {region: tip, topic: /wrench}", "force_scale: {relative: 0.5}"}),
              bar_mesh());
  model.loads().drive(10.0,
                      {sample("/wrench", 10.0, {0, 0, 0, 0, 0, 0}), sample("/wrench", 12.0, {0.2, 0.4, -0.6, 0, 0, 0})});
  Replay replay;
  replay.time = {0.0, 1.0, 2.0};
  add_loads(model, model.parameters().known(), replay);
  ASSERT_EQ(replay.loads.size(), 1U);
  const ReplayLoad& load = replay.loads.front();
  EXPECT_EQ(load.name, "traction on tip");
  EXPECT_EQ(load.unit, "N");
  EXPECT_LT((load.place - Eigen::Vector3d(0.1, 0.01, 0.01)).norm(), 1e-9);
  ASSERT_EQ(load.value.cols(), 3);
  const double scale = model.load_factor(model.parameters().known());
  EXPECT_GT(std::abs(scale - 1.0), 0.1) << "the factor of every measured load acts";
  EXPECT_LT(load.value.col(0).norm(), 1e-12);
  EXPECT_LT((load.value.col(1) - scale * Eigen::Vector3d(0.1, 0.2, -0.3)).norm(), 1e-9);
  EXPECT_LT((load.value.col(2) - scale * Eigen::Vector3d(0.2, 0.4, -0.6)).norm(), 1e-9);
}

TEST(ReplayLoads, AreAPrescribedMotion) {
  Model model(box_settings({"inertia: {density: 1000}", modulus("1e4"), "fixed: {region: clamp}",
                            "moved: {region: tip, topic: /pose, smoothing: 0}"}),
              bar_mesh());
  const Eigen::Vector3d tool(0.3, 0.1, -0.2), way(0.004, 0.0, -0.002);  // the motion counts from rest
  model.loads().set_rest(0.0);
  model.loads().set_first_stamp(0.0);
  for (const double time : {0.0, 1.0, 2.0})
    model.loads().courses().at("/pose")->add(time,
                                             pose_values(Eigen::Isometry3d(Eigen::Translation3d(tool + 0.5 * time * way))));
  Replay replay;
  replay.time = {0.0, 2.0};
  add_loads(model, model.parameters().known(), replay);
  ASSERT_EQ(replay.loads.size(), 1U);
  EXPECT_EQ(replay.loads.front().name, "moved on tip");
  EXPECT_EQ(replay.loads.front().unit, "m");
  EXPECT_LT((replay.loads.front().place - Eigen::Vector3d(0.1, 0.01, 0.01)).norm(), 1e-9);
  EXPECT_LT((replay.loads.front().value.col(1) - way).norm(), 1e-9);
}

TEST(ReplayLoads, ShowWhereTheBodyIsHeld) {
  for (const int cells : {1, 24}) {
    const Model model(box_settings({"inertia: {density: 1000}", modulus("1e4"), "fixed: {region: clamp}"}),
                      bar_mesh(1, cells, cells));
    Replay replay;
    replay.time = {0.0};
    add_loads(model, model.parameters().known(), replay);
    EXPECT_TRUE(replay.loads.empty());
    EXPECT_GE(replay.held.cols(), 8);
    EXPECT_LE(replay.held.cols(), 400);
    EXPECT_EQ(replay.held.row(0).cwiseAbs().maxCoeff(), 0.0) << "the clamp is at x = 0";
  }
}

}  // namespace
}  // namespace tissue_stiffness
