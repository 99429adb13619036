#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "forward/forward_model.hpp"

namespace tissue_stiffness {

/// A corrected surrogate is a cheap model shifted to agree with an accurate one at one theta, the anchor:
///   u(theta, t) = u_cheap(theta, t) + u_accurate(anchor, t) - u_cheap(anchor, t).
/// A fit of it needs one accurate run for every move of the anchor. Where there was an anchor before, the difference goes
/// on changing along the line through both anchors (a secant, as in Broyden 1965).
class CorrectedSurrogate : public ForwardModel {
 public:
  CorrectedSurrogate(const ForwardModel& accurate, const ForwardModel& cheap) : accurate_(&accurate), cheap_(&cheap) {}

  /// Runs both models side by side over `times` [s], ascending; between these times their difference is linear.
  /// `checkpoint` is called before every time of each run; what it throws ends the runs. Throws NumericalError as the runs
  /// do.
  void anchor(
      const Eigen::VectorXd& theta, double start, const std::vector<double>& times,
      const std::function<void()>& checkpoint = [] {});

  /// Lets the difference change along the line from the anchor of `before`, which holds these models over these times at
  /// another anchor. `scale` is one unit of each of theta, 0 where both anchors have the same value.
  void follow(const CorrectedSurrogate& before, const Eigen::VectorXd& scale);

  /// The same with outputs of the accurate model that are known, a column for each time.
  void anchor_to(const Eigen::MatrixXd& accurate, const Eigen::VectorXd& theta, double start,
                 const std::vector<double>& times, const std::function<void()>& checkpoint);
  /// Agrees at theta with what `other`, a surrogate of the same mesh, has at its own anchor. Its accurate model is not run.
  void anchor_as(const CorrectedSurrogate& other, const Eigen::VectorXd& theta, double start,
                 const std::function<void()>& checkpoint);

  /// Takes over the difference of another surrogate of the same mesh, as it is at that one's anchor.
  void move_as(const CorrectedSurrogate& other) {
    times_ = other.times_;
    difference_ = other.difference_;
  }

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  std::string description() const override;

 private:
  void agree(const Eigen::VectorXd& theta, const std::vector<double>& times, Eigen::MatrixXd difference);

  const ForwardModel* accurate_;
  const ForwardModel* cheap_;
  std::vector<double> times_;
  Eigen::VectorXd anchor_;
  Eigen::MatrixXd difference_;  ///< 3n x times
  // Both are empty without an anchor before. `change_` is what the difference changes by in a move as long as the one from
  // there. `along_` is that move, scaled so that its product with another move is that one's share of it.
  Eigen::MatrixXd change_;
  Eigen::VectorXd along_;
};

/// Returns the outputs of a run, a column for each time. Calls `checkpoint` before each.
Eigen::MatrixXd run_outputs(const ForwardModel& model, const Eigen::VectorXd& theta, double start,
                            const std::vector<double>& times, const std::function<void()>& checkpoint);

}  // namespace tissue_stiffness
