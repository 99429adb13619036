#pragma once

#include <string>
#include <vector>

namespace tissue_stiffness {

/// A number that shows whether the numerics are right, with the bounds that theory sets.
struct Figure {
  std::string name;
  double value, lower, upper;
  bool holds() const { return lower <= value && value <= upper; }  // not for NaN
};

/// Linear fields and rigid motions, which every element must get right to round-off.
std::vector<Figure> patch_figures();

/// Static deflection and first natural frequency of a slender cantilever without Poisson effect over those of Timoshenko's
/// beam.
std::vector<Figure> cantilever_figures();

/// Orders of convergence under mesh refinement towards a manufactured solution: p + 1 for displacements in L2, p in the
/// energy norm, for elements of degree p (Strang & Fix 1973, sec. 3.1).
std::vector<Figure> refinement_figures();

/// Order of the time integration, 2, and change of the energy of an undamped bar that swings for 1 s.
std::vector<Figure> time_figures();

/// Largest difference between the unscented filters and Kalman's on random linear models.
std::vector<Figure> kalman_figures();

/// Of 100 simulated recordings: share whose 95 % interval holds the truth, and the innovations' size.
std::vector<Figure> coverage_figures();

}  // namespace tissue_stiffness
