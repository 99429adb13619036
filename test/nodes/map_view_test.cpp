#include "nodes/map_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../box_model.hpp"

namespace tissue_stiffness {
namespace {

// Soft towards x = 0, stiff in the middle, unknown at the far end.
StiffnessMap map_of(const TetMesh& mesh) {
  StiffnessMap map;
  for (const double modulus : {10e3, 40e3, 20e3}) {
    StiffnessPatch patch;
    patch.young_modulus = modulus;
    patch.lower95 = 0.9 * modulus;
    patch.upper95 = 1.1 * modulus;
    patch.identified = map.patches.size() < 2;
    map.patches.push_back(patch);
  }
  map.at_nodes.resize(mesh.node_count());
  for (int i = 0; i < mesh.node_count(); ++i) {
    const double x = mesh.nodes(0, i);
    map.at_nodes[i] = x < 0.03 ? 10e3 : x < 0.06 ? 40e3 : std::numeric_limits<double>::quiet_NaN();
  }
  map.patch_of_tet.assign(static_cast<std::size_t>(mesh.tet_count()), 1);
  return map;
}

TEST(MapMarker, IsGreyWhereTheMapIsAtItsPriorAndBrighterWhereItIsStiffer) {
  const TetMesh mesh = bar_mesh();
  std_msgs::Header header;
  header.frame_id = "model";
  const visualization_msgs::Marker marker = map_marker(map_of(mesh), mesh, header);
  EXPECT_EQ(marker.header.frame_id, "model");
  EXPECT_EQ(marker.type, visualization_msgs::Marker::TRIANGLE_LIST);
  ASSERT_EQ(marker.points.size(), 12U * static_cast<std::size_t>(mesh.facet_count()));
  ASSERT_EQ(marker.colors.size(), marker.points.size());
  for (std::size_t i = 0; i < marker.points.size(); ++i) {
    const auto& c = marker.colors[i];
    const double x = marker.points[i].x;
    const double most = std::max({c.r, c.g, c.b}), least = std::min({c.r, c.g, c.b});
    if (x >= 0.06) {
      EXPECT_EQ(most, least) << "grey at " << x;
    } else {
      EXPECT_GT(most, 2.0 * least) << "coloured at " << x;
      EXPECT_EQ(x<0.03, c.b> c.g) << "dark blue for soft, yellow for stiff, at " << x;
    }
  }
}

TEST(MapMarker, OfOneModulusIsInTheMiddleOfTheScale) {
  const TetMesh mesh = bar_mesh();
  StiffnessMap map = map_of(mesh);
  map.patches.resize(1);
  map.at_nodes.setConstant(10e3);
  for (const auto& c : map_marker(map, mesh, std_msgs::Header()).colors) {
    EXPECT_NEAR(c.g / c.b, 0.567 / 0.551, 1e-3);
    EXPECT_LT(c.r, 0.5 * c.g);
  }
}

TEST(MapMessage, HoldsEveryPatch) {
  const TetMesh mesh = bar_mesh();
  const StiffnessMapMessage message = to_message(map_of(mesh), std_msgs::Header());
  ASSERT_EQ(message.young_modulus.size(), 3U);
  EXPECT_EQ(message.centers.size(), 3U);
  EXPECT_EQ(message.young_modulus[1], 40e3);
  EXPECT_DOUBLE_EQ(message.lower95[1], 36e3);
  EXPECT_DOUBLE_EQ(message.upper95[1], 44e3);
  EXPECT_TRUE(message.identified[1]);
  EXPECT_FALSE(message.identified[2]);
  EXPECT_EQ(message.patch_of_tet.size(), static_cast<std::size_t>(mesh.tet_count()));
}

}  // namespace
}  // namespace tissue_stiffness
