#pragma once

#include <string>

namespace tissue_stiffness {

/// &, <, >, " and ' as entities; control characters other than tab and newline are dropped.
std::string escape_html(const std::string& text);

/// Fewest digits that read back as the same number, whatever the locale; empty for a number that is not finite.
std::string exact_number(double value);

/// A number for people: `digits` significant digits, no exponent between 1e-4 and 1e6; "-" when not finite.
std::string short_number(double value, int digits);

/// A unit with the SI prefix in which `value` reads well: 30e3 Pa -> {1e-3, "kPa"}. Only for Pa, N, m and s; others stay.
struct ShownUnit {
  double scale = 1.0;
  std::string name;
};
ShownUnit shown_unit(double value, const std::string& unit);

/// value in `unit`, rounded to two digits of `uncertainty` ("412.3" for 412.34 +- 0.61); four digits when it is 0 or not
/// finite.
std::string rounded(double value, double uncertainty);

}  // namespace tissue_stiffness
