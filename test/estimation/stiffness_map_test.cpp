// The modulus is mapped on bodies filmed on a finer mesh than the estimator's.
#include <gtest/gtest.h>

#include "bar.hpp"
#include "estimation/map_stiffness.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

TetMesh coarse() {
  return bar_mesh(8, 2, 2);
}

ModelSettings bar_settings(const std::vector<std::string>& moduli, const std::string& fixed = "clamp") {
  std::vector<std::string> effects{"inertia: {density: 1000}", "fixed: {region: " + fixed + "}",
                                   "gravity: {acceleration: [0.5, 1, -3]}"};
  effects.insert(effects.end(), moduli.begin(), moduli.end());
  ModelSettings settings =
      box_settings(effects, "[{vertices: {topic: /vertices, noise: 1.0e-4}}]", "map: {cells: 4, length: 0.03, factor: 2}");
  for (RegionSettings& region : settings.regions) {
    // The box includes the nodes in the middle, whatever their last digit.
    if (region.name == "near") std::get<BoxShape>(region.shape).max.x() += 1e-6;
  }
  return settings;
}

// Returns a model with one unknown modulus, whose mesh error is studied.
ModelSettings unknown(const std::string& fixed = "clamp") {
  ModelSettings settings = bar_settings({modulus(prior(50e3, 3))}, fixed);
  settings.mesh.discretisation_error = true;
  return settings;
}

// Films on a mesh three times as fine, seen at the coarse one's vertices.
std::vector<Frame> recording(const ModelSettings& truth, int count) {
  const Experiment bar(truth, bar_mesh(24, 6, 6), {});
  std::mt19937 engine(1);
  return see_on(coarse(), corners(coarse()), bar, bar.film(0.0, kFilmed, count), kNoise, engine);
}

StiffnessMap mapped(const ModelSettings& settings, const std::vector<Frame>& frames) {
  Estimator estimator(settings, coarse());
  step_through(estimator, frames);
  const StiffnessMap map = map_stiffness({settings, coarse(), frames, {}, frames.front().time, estimator.estimate()});
  for (const StiffnessLevel& level : map.levels) {
    std::printf("%2d patches: mean square %.3f, log-evidence %.0f%s\n", level.patches, level.mean_square,
                level.log_evidence, level.kept ? ", kept" : "");
  }
  for (const StiffnessPatch& p : map.patches) {
    std::printf("  at (%.3f, %.3f, %.3f): %.0f Pa (%.0f to %.0f)%s\n", p.center.x(), p.center.y(), p.center.z(),
                p.young_modulus, p.lower95, p.upper95, p.identified ? "" : ", at its prior");
  }
  return map;
}

const std::vector<std::string> kStiffHalf{modulus("30000", "near"), modulus("90000", "far")};

double truth_at(const StiffnessPatch& patch) {
  return patch.center.x() < 0.05 ? 30e3 : 90e3;
}

TEST(StiffnessMap, FindsAStiffHalf) {
  const StiffnessMap map = mapped(unknown(), recording(bar_settings(kStiffHalf), 40));
  ASSERT_EQ(map.levels.size(), 3U);
  EXPECT_TRUE(map.levels[1].kept);
  ASSERT_EQ(map.patches.size(), 4U);
  EXPECT_EQ(map.identified(), 4);
  for (const StiffnessPatch& p : map.patches) {
    EXPECT_NEAR(p.young_modulus, truth_at(p), 0.15 * truth_at(p));
    EXPECT_LE(p.lower95, truth_at(p));
    EXPECT_GE(p.upper95, truth_at(p));
  }
  const TetMesh mesh = coarse();
  for (int node = 0; node < mesh.node_count(); ++node) {
    const double x = mesh.nodes(0, node);
    if (std::abs(x - 0.05) < 1e-6) continue;
    EXPECT_NEAR(map.at_nodes[node], x < 0.05 ? 30e3 : 90e3, 15e3) << "node " << node;
  }
}

TEST(StiffnessMap, OfAHomogeneousBodyStaysWhole) {
  const StiffnessMap map = mapped(unknown(), recording(bar_settings({modulus("30000")}), 40));
  ASSERT_EQ(map.levels.size(), 3U);
  EXPECT_FALSE(map.levels[1].kept);
  EXPECT_FALSE(map.levels[2].kept);
  ASSERT_EQ(map.patches.size(), 4U);
  for (const StiffnessPatch& p : map.patches) {
    EXPECT_EQ(p.young_modulus, map.patches.front().young_modulus);
    EXPECT_TRUE(p.identified);
    EXPECT_LE(p.lower95, 30e3);
    EXPECT_GE(p.upper95, 30e3);
  }
}

TEST(StiffnessMap, SaysWhichPartsNothingMoves) {
  const StiffnessMap map = mapped(unknown("near"), recording(bar_settings(kStiffHalf, "near"), 40));
  ASSERT_EQ(map.patches.size(), 4U);
  for (const StiffnessPatch& p : map.patches) {
    EXPECT_EQ(p.identified, p.center.x() > 0.05) << p.center.x();
    EXPECT_LE(p.lower95, truth_at(p));
    EXPECT_GE(p.upper95, truth_at(p));
  }
  const TetMesh mesh = coarse();
  for (int node = 0; node < mesh.node_count(); ++node) {
    EXPECT_EQ(std::isnan(map.at_nodes[node]), mesh.nodes(0, node) < 0.05 - 1e-6) << "node " << node;
  }
}

TEST(StiffnessMap, IdentifiesNothingWhereTheModelMissesMoreThanModuli) {
  ModelSettings damped = bar_settings({modulus("30000")});
  add_effect(damped, "viscous_damping: {beta: 0.01}");
  const StiffnessMap map = mapped(unknown(), recording(damped, 40));
  std::printf("misfit %.1f of the noise\n", map.misfit);
  EXPECT_GT(map.misfit, StiffnessMap::kMostMisfit);
  EXPECT_FALSE(map.explains());
  EXPECT_EQ(map.identified(), 0);
  EXPECT_TRUE(map.at_nodes.array().isNaN().all());
}

TEST(StiffnessMap, GivesUpWhenItIsAskedTo) {
  const auto frames = recording(bar_settings(kStiffHalf), 5);
  MapQuestion question{unknown(), coarse(), frames, {}, 0.0, {}};
  int left = 20;
  question.checkpoint = [&left] {
    if (--left < 0) throw NumericalError("given up");
  };
  EXPECT_THROW(map_stiffness(question), NumericalError);
}

TEST(StiffnessMap, NeedsAFrameAfterTheBodysRest) {
  EXPECT_NE(refusal([] { map_stiffness({unknown(), coarse(), {}, {}, 0.0, {}}); }).find("no frame"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
