#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// A part of the body with one modulus, whose distribution is log-normal.
struct StiffnessPatch {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centre of its volume at rest [m]
  double young_modulus = 0.0;                        ///< median [Pa]
  double std = 0.0;                                  ///< standard deviation of log E [-]
  double lower95 = 0.0, upper95 = 0.0;               ///< [Pa]
  bool identified = false;  ///< false: the modulus must not be used; if the map explains() the recording, it is the prior's
};

/// A division of the body that was fitted to the recording.
struct StiffnessLevel {
  int patches = 0;
  double mean_square = 0.0;   ///< mean square of error over noise at this fit [-]
  double log_evidence = 0.0;  ///< relative to the last level that was kept before [-]; 0 for the first
  bool kept = false;
};

/// How the modulus varies over the body. The patches are those of the finest level. All that lie in one patch of the last
/// kept level have its modulus.
struct StiffnessMap {
  std::vector<StiffnessLevel> levels;
  std::vector<StiffnessPatch> patches;
  std::vector<int> patch_of_tet;  ///< -1 where the modulus is not mapped
  Eigen::VectorXd at_nodes;       ///< modulus for display [Pa]; NaN where no patch around the node is identified
  std::string mesh_error;         ///< why the intervals do not include the mesh's error; empty: they do
  double misfit = 0.0;            ///< rms of the last kept level's error over noise, without the mesh's error

  int identified() const;
  /// False means that the body differs from every such map in more than its modulus, or varies within patches. No patch is
  /// identified then.
  bool explains() const { return misfit <= kMostMisfit; }
  static constexpr double kMostMisfit = 2.0;
};

}  // namespace tissue_stiffness
