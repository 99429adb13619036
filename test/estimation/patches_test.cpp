// A body is divided into patches, with a prior over them.
#include "estimation/patches.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>

#include "../box_model.hpp"
#include "estimation/patch_model.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

Patch all_of(const TetMesh& mesh) {
  Patch all(static_cast<std::size_t>(mesh.tet_count()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

double volume(const TetMesh& mesh, const Patch& patch) {
  double sum = 0.0;
  for (const int tet : patch) sum += tet_volume(mesh, tet);
  return sum;
}

TEST(Patches, HoldEachTetrahedronOnceAtEveryLevel) {
  const TetMesh mesh = bar_mesh(8, 2, 2);
  std::vector<Patch> patches{all_of(mesh)};
  for (const int count : {2, 4, 8, 13, 24}) {
    const Division finer = divide_patches(mesh, patches, count);
    ASSERT_EQ(finer.patches.size(), static_cast<std::size_t>(count));
    std::vector<int> times(static_cast<std::size_t>(mesh.tet_count()), 0);
    for (std::size_t r = 0; r < finer.patches.size(); ++r) {
      const Patch& parent = patches[static_cast<std::size_t>(finer.parent[r])];
      EXPECT_TRUE(std::includes(parent.begin(), parent.end(), finer.patches[r].begin(), finer.patches[r].end()));
      for (const int tet : finer.patches[r]) ++times[static_cast<std::size_t>(tet)];
    }
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), mesh.tet_count()) << count << " patches";
    patches = finer.patches;
  }
}

TEST(Patches, AreOfLikeSizeAndCutAcrossTheLength) {
  const TetMesh mesh = bar_mesh(8, 2, 2);
  const Division quarters = divide_patches(mesh, {all_of(mesh)}, 4);
  Eigen::Matrix3Xd middles = centers(mesh, quarters.patches);
  std::vector<double> x(middles.cols());
  Eigen::Map<Eigen::RowVectorXd>(x.data(), middles.cols()) = middles.row(0);
  std::sort(x.begin(), x.end());
  for (std::size_t r = 0; r < x.size(); ++r) {
    EXPECT_NEAR(volume(mesh, quarters.patches[r]), 0.25 * volume(mesh, all_of(mesh)), 1e-6 * 0.25 * 4e-5);
    EXPECT_NEAR(x[r], 0.0125 + 0.025 * static_cast<double>(r), 1e-6);
  }
}

TEST(Patches, EndAtSingleTetrahedra) {
  const TetMesh mesh = bar_mesh(1);
  EXPECT_EQ(divide_patches(mesh, {all_of(mesh)}, 1000).patches.size(), static_cast<std::size_t>(mesh.tet_count()));
}

TEST(SmoothPrior, IsPositiveDefiniteAndFallsWithDistance) {
  const TetMesh mesh = bar_mesh(8, 2, 2);
  const Eigen::Matrix3Xd places = centers(mesh, divide_patches(mesh, {all_of(mesh)}, 40).patches);
  const Eigen::MatrixXd near = smooth_covariance(places, 0.05, std::log(2.0));
  EXPECT_TRUE(near.isApprox(near.transpose()));
  EXPECT_EQ(near.llt().info(), Eigen::Success);
  EXPECT_NEAR(near(0, 0), std::pow(std::log(2.0), 2), 1e-12);
  Eigen::Matrix3Xd line = Eigen::Matrix3Xd::Zero(3, 4);
  line.row(0) << 0.0, 0.01, 0.02, 0.5;
  const Eigen::MatrixXd along = smooth_covariance(line, 0.02, 1.0);
  EXPECT_GT(along(0, 1), along(0, 2));
  EXPECT_NEAR(along(0, 2), (1.0 + std::sqrt(3.0)) * std::exp(-std::sqrt(3.0)), 1e-12);
  EXPECT_LT(along(0, 3), 1e-12);
}

std::string refused(const std::vector<std::string>& effects) {
  std::vector<std::string> all{"inertia: {density: 1000}", "fixed: {region: clamp}"};
  all.insert(all.end(), effects.begin(), effects.end());
  const ModelSettings settings = box_settings(all);
  return refusal([&] { require_map(Model(settings, bar_mesh())); });
}

std::string solid(const std::string& modulus, const std::string& more = "poisson_ratio: 0.45, law: linear") {
  return "elasticity: {young_modulus: " + modulus + ", " + more + "}";
}

TEST(Map, RefusesModelsWithoutOneConstantModulusToMap) {
  const std::string prior = "{prior: 30e3, factor: 3}";
  EXPECT_EQ(refused({solid(prior)}), "");
  EXPECT_NE(refused({solid("30e3")}).find("model.yaml: map: found a model without an estimated young_modulus"),
            std::string::npos);
  EXPECT_NE(refused({solid(prior, "poisson_ratio: 0.45, law: linear, region: near"),
                     solid(prior, "poisson_ratio: 0.45, law: linear, region: far")})
                .find("several"),
            std::string::npos);
  EXPECT_NE(refused({solid("{mean: 30e3, std: 1e3}")}).find("{mean, std}"), std::string::npos);
  EXPECT_NE(refused({solid("{prior: 30e3, factor: 3, drift: 0.1}")}).find("drift"), std::string::npos);
  EXPECT_NE(refused({solid(prior, "poisson_ratio: {mean: 0.4, std: 0.05}, law: linear")}).find("poisson_ratio"),
            std::string::npos);
  EXPECT_NE(refused({solid(prior, "poisson_ratio: 0.45, law: neo_hookean")}).find("not linear"), std::string::npos);
}

TEST(PatchModel, IsTheSameModelWhileThePatchesAgree) {
  const TetMesh mesh = bar_mesh(4, 2, 2);
  const Model whole(box_settings({"inertia: {density: 1000}", solid("{prior: 30e3, factor: 3}"), "fixed: {region: clamp}"}),
                    mesh);
  const Division quarters = divide_patches(mesh, {mapped_tets(whole)}, 4);
  const PatchModel patched = with_patches(whole, quarters.patches, Eigen::VectorXd::Constant(4, std::log(30e3)));
  const Model parts(patched.settings, mesh, patched.regions);
  const SparseMatrix k = whole.stiffness(whole.parameters().theta(whole.parameters().prior_mean()));
  EXPECT_LT((k - parts.stiffness(parts.parameters().theta(parts.parameters().prior_mean()))).norm(), 1e-12 * k.norm());
}

}  // namespace
}  // namespace tissue_stiffness
