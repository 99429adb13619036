#include "nodes/message_conversions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "expect_input_error.hpp"

namespace tissue_stiffness {
namespace {

Contour square() {
  Contour contour;
  contour.width = 64;
  contour.height = 48;
  contour.points.resize(2, 4);
  contour.points << 10, 20, 20, 10, 10, 10, 20, 20;
  contour.normals.resize(2, 4);
  contour.normals << -1, 1, 0, 0, 0, 0, 1, -1;
  contour.sigma = Eigen::Vector4d(0.1, 0.2, 0.3, std::numeric_limits<double>::infinity());
  return contour;
}

TetMesh tetrahedron() {
  TetMesh mesh;
  mesh.nodes.resize(3, 4);
  mesh.nodes << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  mesh.tets = Eigen::Vector4i(0, 1, 2, 3);
  mesh.facets.resize(3, 4);
  mesh.facets << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3;
  mesh.facet_tet = Eigen::Vector4i::Zero();
  mesh.corner_count = 4;
  return mesh;
}

TEST(ContourMessage, ComesBackTheSame) {
  std_msgs::Header header;
  header.stamp = ros::Time(3, 0);
  const Contour in = square();
  const Contour out = to_contour(to_message(in, header), "contour");
  EXPECT_EQ(out.stamp, 3.0);
  EXPECT_EQ(out.width, in.width);
  EXPECT_TRUE(out.closed);
  EXPECT_EQ(out.points, in.points);
  EXPECT_EQ(out.normals, in.normals);
  EXPECT_NEAR(out.sigma[1], 0.2, 1e-7);
  EXPECT_TRUE(std::isinf(out.sigma[3]));
}

TEST(ContourMessage, IsChecked) {
  const auto refused = [](const auto& spoil, const std::vector<std::string>& parts) {
    ContourMessage message = to_message(square(), std_msgs::Header());
    spoil(message);
    expect_input_error([&] { to_contour(message, "contour"); }, parts);
  };
  refused([](ContourMessage& m) { m.v.pop_back(); }, {"contour: v", "3 entries", "4"});
  refused([](ContourMessage& m) { m.sigma.clear(); }, {"contour: sigma", "0 entries"});
  refused([](ContourMessage& m) { m.u[0] = std::nanf(""); }, {"contour: u, v", "finite"});
  refused([](ContourMessage& m) { m.normal_u[1] = 2.0F; }, {"normal_u", "unit"});
  refused([](ContourMessage& m) { m.sigma[2] = 0.0F; }, {"contour: sigma", "> 0"});
  refused([](ContourMessage& m) { m = ContourMessage(); }, {"contour: u", "3 points"});
}

FeatureTracks two_features() {
  FeatureTracks tracks;
  tracks.width = 64;
  tracks.height = 48;
  tracks.ids = Eigen::Vector2i(3, 8);
  tracks.pixels.resize(2, 2);
  tracks.pixels << 10.25, 20, 30, 40.5;
  tracks.reference.resize(2, 2);
  tracks.reference << 11, 21, 29, 39;
  tracks.sigma = Eigen::Vector2d(0.25, 0.5);
  tracks.windows = Eigen::Vector2d(15, 0);
  return tracks;
}

TEST(FeatureTracksMessage, ComesBackTheSame) {
  std_msgs::Header header;
  header.stamp = ros::Time(3, 0);
  const FeatureTracks in = two_features(), out = to_tracks(to_message(in, header), "tracks");
  EXPECT_EQ(out.stamp, 3.0);
  EXPECT_EQ(out.width, 64);
  EXPECT_EQ(out.height, 48);
  EXPECT_EQ(out.ids, in.ids);
  EXPECT_EQ(out.pixels, in.pixels);
  EXPECT_EQ(out.reference, in.reference);
  EXPECT_EQ(out.sigma, in.sigma);
  EXPECT_EQ(out.windows, in.windows);
}

TEST(FeatureTracksMessage, IsChecked) {
  const auto refused = [](const auto& spoil, const std::vector<std::string>& parts) {
    FeatureTracksMessage message = to_message(two_features(), std_msgs::Header());
    spoil(message);
    expect_input_error([&] { to_tracks(message, "tracks"); }, parts);
  };
  refused([](FeatureTracksMessage& m) { m.v.pop_back(); }, {"tracks: v", "1 entries", "2"});
  refused([](FeatureTracksMessage& m) { m.reference_u.clear(); }, {"tracks: reference_u", "0 entries"});
  refused([](FeatureTracksMessage& m) { m.window.clear(); }, {"tracks: window", "0 entries"});
  refused([](FeatureTracksMessage& m) { m.u[0] = std::nanf(""); }, {"tracks: u, v", "finite"});
  refused([](FeatureTracksMessage& m) { m.reference_v[1] = std::nanf(""); },
          {"tracks: reference_u, reference_v", "finite"});
  refused([](FeatureTracksMessage& m) { m.window[1] = -1.0F; }, {"tracks: window", ">= 0"});
  refused([](FeatureTracksMessage& m) { m.sigma[1] = 0.0F; }, {"tracks: sigma", "> 0"});
  refused([](FeatureTracksMessage& m) { m.id[1] = 3; }, {"tracks: id", "3 twice"});
}

TEST(TetMeshMessage, ComesBackTheSame) {
  const TetMesh in = tetrahedron();
  const TetMesh out = to_mesh(to_message(in, std_msgs::Header()), "mesh");
  EXPECT_EQ(out.nodes, in.nodes);
  EXPECT_EQ(out.tets, in.tets);
  EXPECT_EQ(out.facets, in.facets);
  EXPECT_EQ(out.facet_tet, in.facet_tet);
  EXPECT_EQ(out.corner_count, 4);
}

TEST(TetMeshMessage, IsChecked) {
  const auto refused = [](const auto& spoil, const std::vector<std::string>& parts) {
    TetMeshMessage message = to_message(tetrahedron(), std_msgs::Header());
    spoil(message);
    expect_input_error([&] { to_mesh(message, "mesh"); }, parts);
  };
  refused([](TetMeshMessage& m) { m.nodes_per_tet = 8; }, {"mesh: nodes_per_tet", "8", "4 or 10"});
  refused([](TetMeshMessage& m) { m.tets[2] = 4; }, {"mesh: tets", "4", "0 to 3"});
  refused([](TetMeshMessage& m) { m.facets.pop_back(); }, {"mesh: facets", "11 entries"});
  refused([](TetMeshMessage& m) { m.facet_tet.pop_back(); }, {"mesh: facet_tet", "3 entries", "4"});
  refused([](TetMeshMessage& m) { m.nodes[1].y = std::nan(""); }, {"mesh: nodes[1]", "finite"});
  refused([](TetMeshMessage& m) { m.corner_count = 5; }, {"mesh: corner_count", "5", "4"});
  refused([](TetMeshMessage& m) { m.tets.clear(); }, {"mesh: tets", "0 entries"});
  refused([](TetMeshMessage& m) { std::swap(m.tets[0], m.tets[1]); }, {"mesh", "inverted"});
  refused([](TetMeshMessage& m) { m.nodes[3].z = 0.0; }, {"mesh", "tetrahedron 0", "without volume"});
  refused([](TetMeshMessage& m) { m.nodes[3].z = 1e308; }, {"mesh", "coordinate of 1e+308 m", "scale"});
  refused(
      [](TetMeshMessage& m) {
        for (auto& node : m.nodes) node.x *= 1e-9, node.y *= 1e-9, node.z *= 1e-9;
      },
      {"mesh", "longest side is 1e-09 m", "1e-06 m to 1000 m"});
  refused([](TetMeshMessage& m) { m.corner_count = 3; }, {"mesh", "corner_count 3"});
}

TEST(StiffnessMessage, RepeatsTheFirstYoungModulus) {
  Estimate estimate;
  estimate.state = EstimateState::converged;
  estimate.parameters = {{"inertia.density", "kg/m^3", 1000, 10, 980, 1020},
                         {"elasticity.young_modulus", "Pa", 5e5, 1e3, 4.98e5, 5.02e5}};
  estimate.covariance = (Eigen::Matrix2d() << 100, 7, 7, 1e6).finished();
  const StiffnessEstimate out = to_message(estimate, std_msgs::Header());
  EXPECT_EQ(out.state, "converged");
  ASSERT_EQ(out.names.size(), 2U);
  EXPECT_EQ(out.units[1], "Pa");
  EXPECT_EQ(out.covariance, (std::vector<double>{100, 7, 7, 1e6}));
  EXPECT_EQ(out.young_modulus, 5e5);
  EXPECT_EQ(out.young_modulus_std, 1e3);
  EXPECT_EQ(out.young_modulus_upper95, 5.02e5);
  estimate.parameters.pop_back();
  EXPECT_TRUE(std::isnan(to_message(estimate, std_msgs::Header()).young_modulus));
}

TEST(MisfitMessage, RelatesTheErrorToTheMotion) {
  Misfit misfit;
  misfit.rms = 2e-4;
  misfit.motion_rms = 4e-3;
  misfit.count = 160;
  EXPECT_DOUBLE_EQ(to_message(misfit, std_msgs::Header()).relative, 0.05);
  EXPECT_EQ(to_message(misfit, std_msgs::Header()).count, 160U);
  misfit.motion_rms = 0.0;
  EXPECT_TRUE(std::isnan(to_message(misfit, std_msgs::Header()).relative));
}

}  // namespace
}  // namespace tissue_stiffness
