#pragma once

#include <string>

#include "report/results.hpp"

namespace tissue_stiffness {

/// Returns one line for terminals: that every input is taken as exact, or how many errors of the inputs the interval
/// counts.
std::string inputs_line(const Results& results);
/// Returns the sources of a parameter's variance, "noise 3 %, mesh 12 %, ..."; empty when nothing is known.
std::string variance_line(const VarianceShares& shares);
/// Returns the report's section about the interval: each parameter's variance by source, and each input's tolerance with
/// its estimated error.
std::string input_section(const Results& results);

}  // namespace tissue_stiffness
