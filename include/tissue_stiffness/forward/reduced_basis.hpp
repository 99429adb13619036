#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "tissue_stiffness/fem/two_grid.hpp"
#include "tissue_stiffness/forward/model.hpp"

namespace tissue_stiffness {

/// What models of one body share while their stiffness, mass and loads at the prior are the same: the factor of the
/// stiffness, and the vectors from the loads that act there. Thread safe.
class BasisRoot;

/// Vectors that a linear model moves in.
struct ReducedBasis {
  Eigen::MatrixXd vectors;   ///< 3n x m, M-orthonormal at the prior within what one set of held nodes allows
  std::vector<int> support;  ///< of each vector: the part that must let its nodes go for it, -1 for none
  std::vector<char> late;    ///< of each vector: whether it came in the later half of its kind, the less important one
  std::shared_ptr<const BasisRoot> root;
};

struct BasisOptions {
  int size = 48;      ///< vectors from the loads that act at the prior
  int per_part = 32;  ///< more for each effect that is absent at the prior, or whose place or angle is estimated
  int largest = 160;  ///< with those; supports that may give way come on top
  int released = 40;  ///< for each support that may give way
  /// What becomes of effects that are not linear: simulated in full, at first order (FirstOrderModel), or not at all.
  enum class Nonlinear { in_full, first_order, left_out } nonlinear = Nonlinear::in_full;
  int steps_per_frame = 4;  ///< of simulations in full
  /// From the mesh that this one was refined from: the stiffness needs no factor then, vectors are good to about a percent.
  std::shared_ptr<const Prolongation> coarser = nullptr;
  /// A relative's vectors as they are, for a model of the same parts or some of them (by label), in whatever order; and, if
  /// these are all of its vectors, what it has projected onto them.
  bool adopt = false;
  bool keep_root = false;  ///< for models of the same body that are to come; it holds the stiffness's factor
};

/// Load-dependent Ritz vectors (Wilson, Yuan & Dickens 1982), repeated K^-1 M solves from the static responses to the
/// loads. Several moduli: K = sum E_r K_r, the basis holds K^-1 K_r x too. Terms that are zero at the prior give their
/// static responses to the leading motion, K^-1 dK_j x, K^-1 dM_j x and K^-1 dF_j, the most common of them first (proper
/// orthogonal decomposition). `known`: another model's root, taken over as far as it is this one's too: of a body that both
/// share (see Model), with a stiffness in proportion. Throws
/// InputError for a model that nothing moves.
ReducedBasis build_reduced_basis(const Model& model, const BasisOptions& options,
                                 const std::shared_ptr<const BasisRoot>& known = nullptr);

}  // namespace tissue_stiffness
