#pragma once

#include <iosfwd>

#include "tissue_stiffness/types/diagnosis.hpp"
#include "tools/paint.hpp"

namespace tissue_stiffness {

/// Prints the final table of `diagnose`.
void print_diagnosis(const Diagnosis& diagnosis, const Paint& paint, std::ostream& out);

}  // namespace tissue_stiffness
