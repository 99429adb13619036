#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace tissue_stiffness {

/// Returns a value with two significant digits as a sentence has it, so that 217 is not 2.2e+02. Larger values have all
/// digits before the point, and only those below 0.0001 have an exponent.
inline std::string two_digits(double value) {
  char text[400];
  std::snprintf(text, sizeof text, "%.1e", value);  // rounded, so that 9.97 has the order of 10
  const double order =
      std::isfinite(value) && value != 0.0 ? std::floor(std::log10(std::abs(std::strtod(text, nullptr)))) : 0.0;
  if (!std::isfinite(value) || value == 0.0 || order < -4.0 || order > 15.0) {
    std::snprintf(text, sizeof text, "%.2g", value);
  } else {
    std::snprintf(text, sizeof text, "%.*f", std::max(0, 1 - static_cast<int>(order)), value);
  }
  return text;
}

}  // namespace tissue_stiffness
