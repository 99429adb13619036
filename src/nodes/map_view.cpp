#include "nodes/map_view.hpp"

#include <algorithm>
#include <cmath>

#include "nodes/surface_view.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLeastRange = 0.6931;  // log 2
// These are colours of Viridis at equal steps.
constexpr float kScale[5][3] = {{0.267F, 0.005F, 0.329F},
                                {0.229F, 0.322F, 0.546F},
                                {0.128F, 0.567F, 0.551F},
                                {0.369F, 0.789F, 0.383F},
                                {0.993F, 0.906F, 0.144F}};

/// `share`: 0 to 1 along the scale; NaN is grey.
Eigen::Vector3f map_colour(double share) {
  if (!std::isfinite(share)) return Eigen::Vector3f::Constant(0.6F);
  const double place = 4.0 * std::clamp(share, 0.0, 1.0);
  const int below = std::min(static_cast<int>(place), 3);
  const auto rest = static_cast<float>(place - below);
  const auto at = [](int i) { return Eigen::Vector3f(kScale[i][0], kScale[i][1], kScale[i][2]); };
  return (1.0F - rest) * at(below) + rest * at(below + 1);
}

}  // namespace

visualization_msgs::Marker map_marker(const StiffnessMap& map, const TetMesh& mesh, const std_msgs::Header& header) {
  double low = INFINITY, high = -INFINITY;
  for (const StiffnessPatch& patch : map.patches) {
    if (!patch.identified) continue;
    low = std::min(low, std::log(patch.young_modulus));
    high = std::max(high, std::log(patch.young_modulus));
  }
  const double range = std::max(high - low, kLeastRange), middle = 0.5 * (low + high);
  const auto colour = [&](int node) { return map_colour(0.5 + (std::log(map.at_nodes[node]) - middle) / range); };
  return painted_surface(mesh, mesh.nodes, colour, "stiffness_map", header);
}

StiffnessMapMessage to_message(const StiffnessMap& map, const std_msgs::Header& header) {
  StiffnessMapMessage out;
  out.header = header;
  for (const StiffnessPatch& patch : map.patches) {
    geometry_msgs::Point center;
    center.x = patch.center.x();
    center.y = patch.center.y();
    center.z = patch.center.z();
    out.centers.push_back(center);
    out.young_modulus.push_back(patch.young_modulus);
    out.lower95.push_back(patch.lower95);
    out.upper95.push_back(patch.upper95);
    out.identified.push_back(patch.identified ? 1 : 0);
  }
  out.misfit = map.misfit;
  out.patch_of_tet.assign(map.patch_of_tet.begin(), map.patch_of_tet.end());
  return out;
}

}  // namespace tissue_stiffness
