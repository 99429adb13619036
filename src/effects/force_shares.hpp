#pragma once

#include <Eigen/Core>

#include "effects/effect.hpp"

namespace tissue_stiffness {

/// Returns the share that each node has of a force on a region: int N_a dA / A over its facets. A region of vertices that
/// hold no facet, as a hook or a suture makes it, takes the force in equal parts (a point load). Throws InputError, naming
/// the region, where it has neither.
Eigen::VectorXd force_shares(const Value& region, const EffectContext& context);

}  // namespace tissue_stiffness
