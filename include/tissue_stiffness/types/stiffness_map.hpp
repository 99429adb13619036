#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// A part of the body with one modulus, log-normal.
struct StiffnessPatch {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of its volume, at rest [m]
  double young_modulus = 0.0;                        ///< median [Pa]
  double std = 0.0;                                  ///< 1 sigma of log E [-]
  double lower95 = 0.0, upper95 = 0.0;               ///< [Pa]
  bool identified = false;                           ///< false: not to be used; where the map explains(), the prior's
};

/// A division of the body that was fitted.
struct StiffnessLevel {
  int patches = 0;
  double mean_square = 0.0;   ///< of error over noise at its fit [-]
  double log_evidence = 0.0;  ///< over that of the level kept before it [-]; 0 for the first
  bool kept = false;
};

/// How the modulus varies over the body. Patches are the finest; those in one patch of the last level kept agree.
struct StiffnessMap {
  std::vector<StiffnessLevel> levels;
  std::vector<StiffnessPatch> patches;
  std::vector<int> patch_of_tet;  ///< -1 where the modulus is not mapped
  Eigen::VectorXd at_nodes;       ///< for display [Pa]; NaN where no patch around the node is identified
  std::string mesh_error;         ///< why the mesh's error is not part of the intervals; empty: it is
  double misfit = 0.0;            ///< rms over noise that the last level kept leaves, less what the mesh does

  int identified() const;
  /// False: the body differs from every such map by more than its modulus, or within patches. None is identified then.
  bool explains() const { return misfit <= kMostMisfit; }
  static constexpr double kMostMisfit = 2.0;
};

}  // namespace tissue_stiffness
