#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/forward/forward_model.hpp"

namespace tissue_stiffness {

/// A cheap model moved to agree with an accurate one at one theta, the anchor: u(theta, t) = u_cheap(theta, t) +
/// u_accurate(anchor, t) - u_cheap(anchor, t). A fit of it needs one accurate run for every move of the anchor. Where there
/// was an anchor before, the difference goes on changing along the line through both (a secant, as Broyden 1965 has it).
class AnchoredModel : public ForwardModel {
 public:
  AnchoredModel(const ForwardModel& accurate, const ForwardModel& cheap) : accurate_(&accurate), cheap_(&cheap) {}

  /// Runs both over `times` [s], ascending; in between their difference is linear. Throws NumericalError as the runs do.
  /// `checkpoint` is called before every one of them, side by side; what it throws ends the runs.
  void anchor(
      const Eigen::VectorXd& theta, double start, const std::vector<double>& times,
      const std::function<void()>& checkpoint = [] {});

  /// `before`: the same models at another anchor, over the same times. `scale`: what counts as one of each of theta, 0
  /// where both have the same.
  void follow(const AnchoredModel& before, const Eigen::VectorXd& scale);

  /// Moved by as much as another one of the same mesh is at its anchor.
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
  Eigen::VectorXd anchor_;
  Eigen::MatrixXd difference_;  ///< 3n x times
  // Empty without an anchor before: what the difference changes by in a move as long as the one from there, and that move,
  // scaled so that its product with another move is that one's share of it.
  Eigen::MatrixXd change_;
  Eigen::VectorXd along_;
};

}  // namespace tissue_stiffness
