#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "estimation/difference_noise.hpp"
#include "tissue_stiffness/fit/recording.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// Tells how noisy each force sensor of a recording is, and which of its values are outliers. A frame's few force rows
/// cannot tell an outlier, or noise, from a misfit; the sensor's neighbouring values can. Both the measured force and what
/// a model leaves of it hold the sensor's noise, and the rest of each is smoother.
class ForceNoise {
 public:
  ForceNoise(const std::vector<ObservationSettings>& sensors, const std::vector<Frame>& frames);

  /// Forgets the residuals of the last run.
  void start_run() { residual_.clear(); }
  /// Takes note of a frame's residuals (m) in the order of time, and returns which of them are forces.
  std::vector<Eigen::Index> note(const Frame& frame, const Prediction& prediction, const Eigen::VectorXd& residual);
  /// Returns the variance of each force sensor's noise over the stated one; infinity where too few values are known.
  std::map<int, double> found() const;
  /// Sets it.
  void set(int sensor, double variance) { variance_[sensor] = variance; }
  /// Returns the weights of a prediction's rows (m) over their variances, see row_weights.
  Eigen::VectorXd precision(const Frame& frame, const Prediction& prediction) const;

 private:
  std::map<int, DifferenceNoise> measured_, residual_;  ///< over the stated noise
  std::map<int, std::map<double, double>> weights_;     ///< of a sensor's values, by their frames' times
  std::map<int, double> variance_;
};

}  // namespace tissue_stiffness
