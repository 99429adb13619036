#pragma once

#include <string>

namespace tissue_stiffness {

/// Returns a finite value with so many decimals, and a point whatever the locale.
std::string with_decimals(double value, int decimals);
/// Returns the position of the leading digit once a value other than zero is rounded to so many digits: 0 for 0.9996 with
/// three of them.
int leading_place(double value, int digits);

}  // namespace tissue_stiffness
