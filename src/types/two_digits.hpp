#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "types/formatted.hpp"
#include "types/plain_number.hpp"

namespace tissue_stiffness {

/// Returns a value with two significant digits as a sentence has it, so that 217 is not 2.2e+02. Larger values have all
/// digits before the point, and only those below 0.0001 have an exponent.
inline std::string two_digits(double value) {
  const int place = std::isfinite(value) && value != 0.0 ? leading_place(value, 2) : 0;
  if (std::isfinite(value) && value != 0.0 && place >= -4 && place <= 15)
    return with_decimals(value, std::max(0, 1 - place));
  return formatted("%.2g", value);
}

}  // namespace tissue_stiffness
