#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/forward/forward_model.hpp"

namespace tissue_stiffness {

/// A cheap model moved to agree with an accurate one at one theta, the anchor: u(theta, t) = u_cheap(theta, t) +
/// u_accurate(anchor, t) - u_cheap(anchor, t). A fit of it needs one accurate run for every move of the anchor.
class AnchoredModel : public ForwardModel {
 public:
  AnchoredModel(const ForwardModel& accurate, const ForwardModel& cheap) : accurate_(&accurate), cheap_(&cheap) {}

  /// Runs both over `times` [s], ascending; in between their difference is linear. Throws NumericalError as the runs do.
  void anchor(const Eigen::VectorXd& theta, double start, const std::vector<double>& times);

  /// Moved by as much as another one of the same mesh.
  void move_as(const AnchoredModel& other) {
    times_ = other.times_;
    difference_ = other.difference_;
  }

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  std::string description() const override;

 private:
  const ForwardModel* accurate_;
  const ForwardModel* cheap_;
  std::vector<double> times_;
  Eigen::MatrixXd difference_;  ///< 3n x times
};

}  // namespace tissue_stiffness
