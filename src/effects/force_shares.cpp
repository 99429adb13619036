#include "effects/force_shares.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/cross_matrix.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kThin = 1e-6;  // smallest over largest second moment of a region that is a line

}  // namespace

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

std::vector<Eigen::VectorXd> wrench_patterns(const Value& arguments, const EffectContext& context) {
  const Eigen::VectorXd shares = force_shares(arguments.at("region"), context);
  std::vector<Eigen::VectorXd> out;
  out.reserve(6);
  for (int i = 0; i < 3; ++i) out.push_back(along_axis(shares, i));
  if (!arguments.has("torque_about")) return out;
  const Eigen::Vector3d about = arguments.at("torque_about").as_vector3("m"), centre = context.mesh.nodes * shares;
  const Eigen::Matrix3Xd from_centre = context.mesh.nodes.colwise() - centre;
  const Eigen::Matrix3d second = from_centre * shares.asDiagonal() * from_centre.transpose();
  const Eigen::Matrix3d inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(inertia);
  if (!(eigen.eigenvalues()[0] > kThin * eigen.eigenvalues()[2])) {
    throw InputError(arguments.at("region").path(), arguments.at("region").shown(),
                     "with `torque_about`, a region that is neither a point nor a line, because those take no torque");
  }
  const Eigen::Matrix3d turn = inertia.inverse();                     // theta of a unit torque
  const Eigen::Matrix3d lever = turn * cross_matrix(about - centre);  // and of a unit force
  const auto turned = [&](const Eigen::Vector3d& theta) {
    const Eigen::Matrix3Xd forces = cross_matrix(theta) * from_centre * shares.asDiagonal();
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(forces.data(), forces.size()));
  };
  for (int i = 0; i < 3; ++i) out[static_cast<std::size_t>(i)] += turned(lever.col(i));
  for (int i = 0; i < 3; ++i) out.push_back(turned(turn.col(i)));
  return out;
}

}  // namespace tissue_stiffness
