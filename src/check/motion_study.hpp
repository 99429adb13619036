#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "forward/forward_model.hpp"
#include "observation/observation_operator.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// Frames and the loads that act during them.
struct Recorded {
  std::vector<Frame> frames;  ///< in order of time, none before the body is at rest
  std::vector<LoadSample> loads;
  double first_stamp = 0.0;  ///< [s]
};

/// The measured motion, and the prediction of the model's linear form. The predictions are free runs in the reduced basis
/// at moduli over the whole prior. Motion is what a sensor observes beyond the body at rest, y - h(0) and h(u) - h(0) [m].
/// It is 0 in rows without a counterpart.
class MotionStudy {
 public:
  /// Number of frames that are used, evenly over the recording, where some points have no identities.
  static constexpr std::size_t most_outlines = 12;

  /// Throws InputError as Model does, and for a model that nothing moves. Throws NumericalError for a stiffness without a
  /// factor.
  MotionStudy(const ModelSettings& settings, const TetMesh& mesh, const Recorded& recorded);

  /// Returns whether a linear run from rest can represent this model: it has no contact, no initial velocity from frames,
  /// and some sensor sees the motion.
  static bool applies(const ModelSettings& settings);

  const Eigen::VectorXd& measured() const { return measured_; }
  /// These return, for each row, the index in the model file's list of observations and the number of its frame.
  const std::vector<int>& sources() const { return sources_; }
  const std::vector<int>& frames() const { return frame_of_; }
  /// Returns the effects with a measured load, as indices of the model file's list.
  const std::vector<std::size_t>& loads() const { return loads_; }
  /// Returns whether some modulus is estimated.
  bool modulus_is_free() const { return (moduli_.array() != 0.0).any(); }

  /// Returns the predicted motion with every estimated modulus z prior standard deviations (of its logarithm) above its
  /// median. The load of effect `without` is left out.
  Eigen::VectorXd predicted(double z, std::ptrdiff_t without = -1) const;
  /// Returns z in -3 to 3 at which the prediction is nearest to the measurement, by a grid and a golden section. It is 0
  /// without a free modulus.
  double best_modulus() const;

 private:
  double search() const;

  Model model_;
  std::unique_ptr<ForwardModel> forward_;
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
  std::vector<Frame> shown_;
  std::vector<Eigen::VectorXd> at_rest_;  ///< one for each frame
  double start_ = 0.0;                    ///< [s]
  Eigen::VectorXd measured_;
  std::vector<int> sources_, frame_of_;
  std::vector<std::size_t> loads_;
  mutable std::optional<double> best_;
  Eigen::VectorXd moduli_;  ///< prior standard deviation of each free modulus, 0 for other free parameters
};

}  // namespace tissue_stiffness
