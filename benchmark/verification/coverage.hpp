#pragma once

#include <vector>

namespace tissue_stiffness {

/// What the estimator said about one simulated recording.
struct Trial {
  double start;     ///< prior median over the truth
  double off;       ///< (estimate - truth) / posterior standard deviation, of log E
  double relative;  ///< posterior standard deviation of log E
  bool covered;     ///< 95 % interval holds the truth
  double nis;       ///< summed over the frames
  double dof;
};

/// Calibration: a bar released under gravity and filmed; noise and starting point drawn anew for every seed, the starting
/// point log-normal about the truth with the prior's own factor, as Bayes' theorem presumes.
std::vector<Trial> calibrate(int seeds);

}  // namespace tissue_stiffness
