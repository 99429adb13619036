#pragma once

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {

/// Returns in how many steps a run goes on by a span [s] where a force has to be evaluated in each of them: at least two,
/// of at most 10 ms.
inline int force_steps(double span) {
  constexpr double longest = 0.010, share = 0.5;
  return static_cast<int>(std::ceil(span / std::min(longest, share * span) * (1.0 - 1e-9)));
}

}  // namespace tissue_stiffness
