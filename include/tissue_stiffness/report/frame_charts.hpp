#pragma once

#include <string>

#include "tissue_stiffness/report/results.hpp"

namespace tissue_stiffness {

/// "elasticity.young_modulus" -> "Young's modulus (elasticity)".
std::string parameter_title(const std::string& name);

/// Every parameter over time with its band (and a close-up of the later frames where the first ones dwarf them), then the
/// misfit with the noise. Long runs are thinned to at most 1500 points, keeping the extremes. Empty without frames.
std::string frame_charts(const Results& results);

}  // namespace tissue_stiffness
