#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "tissue_stiffness/forward/forward_model.hpp"
#include "tissue_stiffness/forward/observation_operator.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// Frames with the loads that drove them.
struct Recorded {
  std::vector<Frame> frames;  ///< in order of time, none before the body's rest
  std::vector<LoadSample> loads;
  double first_stamp = 0.0;  ///< [s]
};

/// The measured motion, and what the model's linear form predicts of it: free runs in the reduced basis at moduli over the
/// whole prior. Motion is what a sensor sees beyond the body at rest, y - h(0) and h(u) - h(0) [m], 0 in rows without a
/// counterpart.
class MotionStudy {
 public:
  /// Frames that are looked at, evenly over the recording, where some have no identities.
  static constexpr std::size_t most_outlines = 12;

  /// Throws InputError as Model does, and for a model that nothing moves; NumericalError for a stiffness without a factor.
  MotionStudy(const ModelSettings& settings, const TetMesh& mesh, const Recorded& recorded);

  /// A linear run from rest stands for this model: no contact, no start in motion that frames tell.
  static bool applies(const ModelSettings& settings);

  const Eigen::VectorXd& measured() const { return measured_; }
  /// Row of the model file's observations that each row belongs to, and number of its frame.
  const std::vector<int>& sources() const { return sources_; }
  const std::vector<int>& frames() const { return frame_of_; }
  /// Effects with a measured load, as indices of the model file's.
  const std::vector<std::size_t>& loads() const { return loads_; }
  /// Some modulus is estimated.
  bool modulus_is_free() const { return (moduli_.array() != 0.0).any(); }

  /// Predicted motion where every estimated modulus is z prior standard deviations (of its logarithm) above its median;
  /// without the load of effect `without`.
  Eigen::VectorXd predicted(double z, std::ptrdiff_t without = -1) const;
  /// z in -3 to 3 at which the prediction is nearest to the measurement, by a grid and a golden section; 0 without a free
  /// modulus.
  double best_modulus() const;

 private:
  double search() const;

  Model model_;
  std::unique_ptr<ForwardModel> forward_;
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
  std::vector<Frame> shown_;
  std::vector<Eigen::VectorXd> at_rest_;  ///< of each frame
  double start_ = 0.0;                    ///< [s]
  Eigen::VectorXd measured_;
  std::vector<int> sources_, frame_of_;
  std::vector<std::size_t> loads_;
  mutable std::optional<double> best_;
  Eigen::VectorXd moduli_;  ///< prior standard deviation of each free parameter that is a modulus, 0 for others
};

}  // namespace tissue_stiffness
