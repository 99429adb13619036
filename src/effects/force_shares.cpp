#include "effects/force_shares.hpp"

#include <vector>

#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

Eigen::VectorXd force_shares(const Value& region, const EffectContext& context) {
  const TetMesh& mesh = context.mesh;
  const Region& found = find_region(region, context.regions);
  if (!found.facets.empty()) return facet_mean(mesh, found.facets);
  std::vector<char> outside(static_cast<std::size_t>(mesh.node_count()), 0);
  for (Eigen::Index i = 0; i < mesh.facets.size(); ++i) outside[static_cast<std::size_t>(mesh.facets.data()[i])] = 1;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(mesh.node_count());
  for (const int node : found.nodes) out[node] = outside[static_cast<std::size_t>(node)];
  if (!(out.sum() > 0.0)) {
    throw InputError(region.path(), region.shown(), "a region that holds boundary facets, or vertices of the surface");
  }
  return out / out.sum();
}

}  // namespace tissue_stiffness
