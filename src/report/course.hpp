#pragma once

#include <string>

#include "report/results.hpp"

namespace tissue_stiffness {

/// Returns a parameter's title: "elasticity.young_modulus" -> "Young's modulus (elasticity)".
std::string parameter_title(const std::string& name);

/// Returns the data of the charts over time as JSON: time [s] since `first_stamp`,
/// parameters[].{name,title,unit,scale,mean,lower,upper} in the displayed unit, misfit and noise [mm], sigmas, times of
/// skipped frames. Long runs are thinned to at most 1500 points. The extremes of intervals and misfit are kept.
std::string course_json(const Results& results, double first_stamp);

}  // namespace tissue_stiffness
