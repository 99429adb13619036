#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/two_grid.hpp"
#include "forward/model.hpp"

namespace tissue_stiffness {

/// The part of a basis that models of one body share while their stiffness, mass and loads at the prior are the same. It
/// holds the factor of the stiffness and the vectors of the loads that are active there. Thread safe.
class BasisRoot;

/// Vectors that span the motion of a linear model.
struct ReducedBasis {
  Eigen::MatrixXd vectors;   ///< 3n x m, M-orthonormal at the prior for one set of held nodes
  std::vector<int> support;  ///< for each vector: the part that must release its nodes for it, -1 for none
  std::vector<char> late;    ///< for each vector: whether it is in the later, less important half of its kind
  std::shared_ptr<const BasisRoot> root;
};

struct BasisOptions {
  int size = 48;      ///< vectors of the loads that are active at the prior; more than eight loads have six each
  int per_part = 32;  ///< more for each effect that is absent at the prior, or whose place or angle is estimated
  int largest = 160;  ///< limit of their sum; vectors for compliant supports are added to it
  int released = 40;  ///< vectors for each support that may be compliant
  int growths = 0;    ///< so many times all of these grow by half
  /// How nonlinear effects are treated: simulated in full, at first order (FirstOrderModel), or left out.
  enum class Nonlinear { in_full, first_order, left_out } nonlinear = Nonlinear::in_full;
  int steps_per_frame = 4;  ///< for simulations in full
  /// Extrapolates simulations in full from two lengths of steps, where the model file states none and all is smooth.
  bool extrapolated = false;
  /// Interpolation from the mesh that this one was refined from. The stiffness then needs no factor, and vectors are
  /// accurate to about a percent.
  std::shared_ptr<const Prolongation> coarser = nullptr;
  /// Takes a relative's vectors unchanged, for a model with the same parts or some of them (by label), in any order. If
  /// these are all of its vectors, its projections onto them are taken, too.
  bool adopt = false;
  /// The vectors are chosen for these parameters and for those that are so far from them, in the filter's coordinates;
  /// empty: the prior's mean and standard deviation.
  Eigen::VectorXd around = {}, reach = {};
  bool keep_root = false;  ///< for later models of the same body; it holds the stiffness's factor

  /// Returns these options with the sizes that the growths lead to, and no growths.
  BasisOptions grown() const;
  /// Returns these options with nonlinear effects left out.
  BasisOptions linear_form() const {
    BasisOptions out = *this;
    out.nonlinear = Nonlinear::left_out;
    return out;
  }
};

/// Builds load-dependent Ritz vectors (Wilson, Yuan & Dickens 1982): repeated K^-1 M solves from the static responses to
/// the loads. With several moduli, K = sum E_r K_r, the basis also holds K^-1 K_r x. Terms that are zero at the prior
/// contribute their static responses to the leading motion, K^-1 dK_j x, K^-1 dM_j x and K^-1 dF_j, the most common of them
/// first (proper orthogonal decomposition). `known`: another model's root, which is reused as far as it is identical. This
/// needs the same shared body (see Model) and a proportional stiffness. Throws InputError for a model that nothing moves.
ReducedBasis build_reduced_basis(const Model& model, const BasisOptions& options,
                                 const std::shared_ptr<const BasisRoot>& known = nullptr);

}  // namespace tissue_stiffness
