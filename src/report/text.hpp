#pragma once

#include <string>

namespace tissue_stiffness {

/// Replaces &, <, >, " and ' by entities. Control characters other than tab and newline are dropped.
std::string escape_html(const std::string& text);

/// Writes the fewest digits that read back as the same number, in any locale. The text is empty for a number that is not
/// finite.
std::string exact_number(double value);

/// Writes a number for the reader: `digits` significant digits, no exponent between 1e-4 and 1e6; "-" when not finite.
std::string short_number(double value, int digits);

/// Writes a number with so many decimals and without the sign of a zero: "0.0" for -0.04; "-" when not finite.
std::string fixed_number(double value, int decimals);

/// Writes a length: "0.35 mm"; "-" when not finite.
std::string millimetres(double metres);

/// A unit with the SI prefix that suits `value`: 30e3 Pa -> {1e-3, "kPa"}. Only Pa, N, m and s get a prefix.
struct ShownUnit {
  double scale = 1.0;
  std::string name;
};
ShownUnit shown_unit(double value, const std::string& unit);

/// Writes a value rounded to two digits of `uncertainty` ("412.3" for 412.34 +- 0.61). It has four digits when the
/// uncertainty is 0 or not finite.
std::string rounded(double value, double uncertainty);

}  // namespace tissue_stiffness
