#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "types/plain_number.hpp"

namespace tissue_stiffness {

/// Returns a value with two significant digits as a sentence has it, so that 217 is not 2.2e+02. Larger values have all
/// digits before the point, and only those below 0.0001 have an exponent.
inline std::string two_digits(double value) {
  const int place = std::isfinite(value) && value != 0.0 ? leading_place(value, 2) : 0;
  if (std::isfinite(value) && value != 0.0 && place >= -4 && place <= 15)
    return with_decimals(value, std::max(0, 1 - place));
  char text[40];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

}  // namespace tissue_stiffness
