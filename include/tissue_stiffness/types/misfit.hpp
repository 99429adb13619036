#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// How far measurement and model are apart in one frame, at the estimate.
struct Misfit {
  double time = 0.0;            ///< [s]
  int count = 0;                ///< rows compared
  int outliers = 0;             ///< rows down-weighted below one half
  double rms = 0.0;             ///< [m]
  double rms_sigma = 0.0;       ///< rms of error / sigma [-]
  double motion_rms = 0.0;      ///< rms of the measured motion since rest [m]
  double nis = 0.0;             ///< normalised innovation squared, e^T S^-1 e
  int dof = 0;                  ///< rows in `nis`
  Eigen::VectorXd node_error;   ///< error at each mesh node [m]; NaN where nothing was measured
  Eigen::VectorXd node_sigmas;  ///< error / sigma at each mesh node; NaN where nothing was measured
};

}  // namespace tissue_stiffness
