#pragma once

#include <Eigen/Core>
#include <vector>

#include "effects/effect.hpp"

namespace tissue_stiffness {

/// Returns the share that each node has of a force on a region: int N_a dA / A over its facets. A region of vertices that
/// hold no facet, as a hook or a suture makes it, takes the force in equal parts (a point load). Throws InputError, naming
/// the region, where it has neither.
Eigen::VectorXd force_shares(const Value& region, const EffectContext& context);

/// Returns the nodal forces (3n) of a unit of each component of the wrench on the key `region`: three forces [N], and three
/// torques [N m] with the key `torque_about`, a point a. Node b, at r_b from the region's centre c, has the share w_b that
/// force_shares() tells, and takes
///   f_b = w_b (F + theta x r_b),  J theta = T + (a - c) x F,  J = sum_b w_b (|r_b|^2 I - r_b r_b^T).
/// These are the least forces, by sum_b |f_b|^2 / w_b, whose sum is F and whose torque about a is T. Without the key,
/// theta is 0. Throws InputError where the region is a point or a line, which takes no torque about itself.
std::vector<Eigen::VectorXd> wrench_patterns(const Value& arguments, const EffectContext& context);

}  // namespace tissue_stiffness
