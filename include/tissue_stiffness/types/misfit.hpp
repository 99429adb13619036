#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Difference between measurement and model in one frame, at the estimate.
struct Misfit {
  double time = 0.0;            ///< [s]
  int count = 0;                ///< number of rows that were compared
  int lengths = 0;              ///< those of them that are lengths, and no forces
  int outliers = 0;             ///< number of rows whose weight is below one half
  double rms = 0.0;             ///< rms of the lengths' error [m]
  double rms_sigma = 0.0;       ///< rms of the error over sigma [-]
  double motion_rms = 0.0;      ///< rms of the measured motion since rest [m]
  double nis = 0.0;             ///< normalised innovation squared, e^T S^-1 e
  int dof = 0;                  ///< number of rows in `nis`
  Eigen::VectorXd node_error;   ///< error at each mesh node [m]; NaN where nothing was measured
  Eigen::VectorXd node_sigmas;  ///< error / sigma at each mesh node; NaN where nothing was measured
};

}  // namespace tissue_stiffness
