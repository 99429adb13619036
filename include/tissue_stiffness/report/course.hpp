#pragma once

#include <string>

#include "tissue_stiffness/report/results.hpp"

namespace tissue_stiffness {

/// "elasticity.young_modulus" -> "Young's modulus (elasticity)".
std::string parameter_title(const std::string& name);

/// What the charts over time draw, as JSON: time [s] since `first_stamp`, parameters[].{name,title,unit,mean,lower,upper}
/// in the unit in which they are shown, misfit and noise [mm], sigmas, times of skipped frames. Long runs are thinned to at
/// most 1500 points that keep the extremes of bands and misfit.
std::string course_json(const Results& results, double first_stamp);

}  // namespace tissue_stiffness
