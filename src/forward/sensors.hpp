#pragma once

#include <Eigen/Core>
#include <vector>

#include "forward/model_part.hpp"

namespace tissue_stiffness {

/// What the effects of a model do to its measurements, in the order of the model file.
class Sensors {
 public:
  Sensors() = default;
  Sensors(const TetMesh& mesh, const std::vector<ModelPart>& parts);

  /// Returns whether some effect belongs to the observation.
  bool any() const { return !members_.empty(); }
  /// Returns the delay of the measurements' stamps [s].
  double delay(const Eigen::VectorXd& theta) const;
  /// Returns the motion as a sensor observes it `since` seconds after the start.
  ObservedMotion observe(const Eigen::VectorXd& theta, double since,
                         const Eigen::Ref<const Eigen::VectorXd>& displacement) const;

 private:
  const TetMesh* mesh_ = nullptr;
  std::vector<ModelPart> members_;  ///< without terms
};

}  // namespace tissue_stiffness
