#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace tissue_stiffness {

/// What the last corrections of a quasi-Newton iteration tell about the Jacobian J beyond an inverse H0 of it that is at
/// hand: H r = after(H0 before(r)) is BFGS's inverse of J times r, by the two-loop recursion of L-BFGS (Nocedal & Wright
/// 2006, alg. 7.4). The vectors stay when they are forgotten, for those that follow.
class BfgsUpdates {
 public:
  void clear() { count_ = 0; }
  /// Takes over a correction s and J s, the change of the residual with its sign turned, in exchange for vectors of no
  /// meaning; leaves both alone where they say nothing. The oldest gives way.
  void learn(Eigen::VectorXd& step, Eigen::VectorXd& change);
  void before(Eigen::Ref<Eigen::VectorXd> r);
  void after(Eigen::VectorXd& direction) const;

 private:
  struct Update {
    Eigen::VectorXd step, change;
    double inverse_curvature;  ///< 1 / step . change
    double weight;             ///< step . r / step . change, from the first loop
  };
  static constexpr std::size_t kMost = 8;
  Update& update(std::size_t age) { return updates_[(newest_ + kMost - age) % kMost]; }
  const Update& update(std::size_t age) const { return updates_[(newest_ + kMost - age) % kMost]; }

  std::array<Update, kMost> updates_;
  std::size_t newest_ = 0, count_ = 0;
};

}  // namespace tissue_stiffness
