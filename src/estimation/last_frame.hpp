#pragma once

#include <Eigen/Core>
#include <functional>
#include <utility>

#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// This is what an estimator has made of its last frame.
class LastFrame {
 public:
  using Recover = std::function<void(Eigen::Ref<Eigen::VectorXd>)>;  ///< writes the displacement of all nodes, 3n [m]

  /// Before the first frame: the prior, at rest.
  LastFrame(Estimate prior, int nodes) : estimate(std::move(prior)), displacement_(Eigen::Matrix3Xd::Zero(3, nodes)) {}

  Estimate estimate;
  Prediction prediction;

  /// Returns the displacement of every node at the estimate [m].
  const Eigen::Matrix3Xd& displacement() const {
    if (recover_) {
      recover_(Eigen::Map<Eigen::VectorXd>(displacement_.data(), displacement_.size()));
      recover_ = nullptr;
    }
    return displacement_;
  }
  /// Puts off the work until the displacement is asked for.
  void set_displacement(Recover recover) { recover_ = std::move(recover); }

 private:
  mutable Eigen::Matrix3Xd displacement_;
  mutable Recover recover_;
};

}  // namespace tissue_stiffness
