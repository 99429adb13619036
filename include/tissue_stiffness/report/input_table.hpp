#pragma once

#include <string>

#include "tissue_stiffness/report/results.hpp"

namespace tissue_stiffness {

/// "with the wrench taken as exact", or how many errors of the inputs the interval counts; one line for terminals.
std::string inputs_line(const Results& results);
/// "noise 3 %, mesh 12 %, ...": where the variance of a parameter comes from; empty when nothing is known.
std::string variance_line(const VarianceShares& shares);
/// Section of the report: each parameter's variance by source, and each input's tolerance with what was found of its error.
std::string input_section(const Results& results);

}  // namespace tissue_stiffness
