#pragma once

#include <Eigen/Core>
#include <string>

namespace tissue_stiffness {

/// Returns a finite value with so many decimals, and a point whatever the locale.
std::string with_decimals(double value, int decimals);
/// The same, with "-" for a value that is not finite, and without the sign of a zero.
std::string fixed_number(double value, int decimals);
/// Returns a position [m] in whole millimetres, without the unit: "(-3, 13, 41)".
std::string position_in_millimetres(const Eigen::Vector3d& position);
/// Returns the position of the leading digit once a value other than zero is rounded to so many digits: 0 for 0.9996 with
/// three of them.
int leading_place(double value, int digits);

}  // namespace tissue_stiffness
