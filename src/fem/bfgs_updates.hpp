#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace tissue_stiffness {

/// BFGS updates of an inverse Jacobian from the last corrections of a quasi-Newton iteration. With an available inverse H0
/// of the Jacobian J, H r = after(H0 before(r)) is BFGS's inverse of J times r, by the two-loop recursion of L-BFGS
/// (Nocedal & Wright 2006, alg. 7.4). Forgotten updates keep their vectors, so that later ones need no memory.
class BfgsUpdates {
 public:
  void clear() { count_ = 0; }
  /// Stores a correction s and J s, which is the negative change of the residual. It swaps in the vectors of the oldest
  /// update, whose values mean nothing any more. Both arguments are left unchanged when they contain no information.
  void learn(Eigen::VectorXd& step, Eigen::VectorXd& change);
  void before(Eigen::Ref<Eigen::VectorXd> r);
  void after(Eigen::VectorXd& direction) const;

 private:
  struct Update {
    Eigen::VectorXd step, change;
    double inverse_curvature;  ///< 1 / (step . change)
    double weight;             ///< step . r / (step . change), from the first loop
  };
  static constexpr std::size_t kMost = 8;
  Update& update(std::size_t age) { return updates_[(newest_ + kMost - age) % kMost]; }
  const Update& update(std::size_t age) const { return updates_[(newest_ + kMost - age) % kMost]; }

  std::array<Update, kMost> updates_;
  std::size_t newest_ = 0, count_ = 0;
};

}  // namespace tissue_stiffness
