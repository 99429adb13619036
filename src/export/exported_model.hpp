#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "forward/model.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// A load of one effect, as forces on the nodes.
struct ExportedLoad {
  std::string name;        ///< the effect and its region
  Eigen::Matrix3Xd force;  ///< of every node [N]
};

/// A region whose motion is prescribed.
struct ExportedMotion {
  std::string name;  ///< the effect and its region
  std::vector<int> nodes;
  Eigen::Matrix3Xd displacement;  ///< of each of these nodes [m]
};

/// A model with all its numbers at one instant, for other programs. It holds what at least one of their formats can
/// express; `remarks` names everything else.
struct ExportedModel {
  std::string title;  ///< one line about where it comes from
  double time = 0.0;  ///< of the loads, after the recording's first stamp [s]
  TetMesh mesh;
  Eigen::VectorXd young_modulus, poisson_ratio, density;  ///< of each tetrahedron [Pa], [-], [kg/m^3]
  bool finite_strain = false;  ///< the law is the compressible neo-Hookean one, otherwise Hooke's for small strain
  std::vector<char> fixed;     ///< whether each node is held at rest
  std::vector<ExportedLoad> loads;
  std::vector<ExportedMotion> motions;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();   ///< [m/s^2]
  Eigen::Matrix3Xd weight;                             ///< its force on every node [N]
  double mass_damping = 0.0, stiffness_damping = 0.0;  ///< Rayleigh's alpha [1/s] and beta [s]
  std::vector<std::string> remarks;                    ///< one sentence for each thing that is left out or differs

  /// Returns the sum of all loads without the weight, for every node [N].
  Eigen::Matrix3Xd force() const;
};

/// Fills the value from a model at theta whose loads are known. `time` is on the recording's clock [s]. `mapped_modulus`
/// has a number for each tetrahedron, NaN where theta holds [Pa]; it is empty without a map. `common_modulus` is the
/// modulus that the map replaces.
ExportedModel export_model(const Model& model, const Eigen::VectorXd& theta, double time,
                           const Eigen::VectorXd& mapped_modulus = {}, double common_modulus = 1.0);

/// Returns the one of `times` at which the measured loads are largest (norm of the nodal forces), or the prescribed motions
/// where no load is measured. These are linear between their samples, so the samples' times are all that matter. Without
/// loads and motions it returns the recording's first stamp. All times are on the recording's clock [s].
double time_of_largest_load(const Model& model, const Eigen::VectorXd& theta, const std::vector<double>& times);

}  // namespace tissue_stiffness
