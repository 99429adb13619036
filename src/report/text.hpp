#pragma once

#include <map>
#include <string>

#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

/// Replaces &, <, >, " and ' by entities. Control characters other than tab and newline are dropped.
std::string escape_html(const std::string& text);

/// Makes the first letter, one of a to z, a capital.
std::string capitalised(std::string text);

/// Writes the fewest digits that read back as the same number, in any locale. The text is empty for a number that is not
/// finite.
std::string exact_number(double value);

/// Writes a number for the reader: `digits` significant digits, no exponent between 1e-4 and 1e6; "-" when not finite.
std::string short_number(double value, int digits);

/// Writes a length: "0.35 mm"; "-" when not finite.
std::string millimetres(double metres);

/// Writes a share: "88.4 %"; "< 0.1 %" and "> 99.9 %" beyond these, "-" when not finite.
std::string percentage(double share, int digits);

/// Writes the statistic of a test, which says no more beyond "> 100"; "-" when not finite.
std::string test_statistic(double z);

/// A unit with the SI prefix that suits `value`: 30e3 Pa -> {1e-3, "kPa"}. Units that begin with Pa, N, m, s or rad get a
/// prefix, and kilograms become grams: 1.5e-8 m^3/N -> {1e9, "mm^3/N"}. Other units keep their name; "-" is shown as "",
/// and as % below a thousandth.
struct ShownUnit {
  double scale = 1.0;
  std::string name;
};
ShownUnit shown_unit(double value, const std::string& unit);

/// Writes a number in the unit that suits it: "24.2 ms"; "-" when not finite.
std::string with_unit(double value, const std::string& unit, int digits = 3);

/// Writes a value rounded to two digits of `uncertainty` ("412.3" for 412.34 +- 0.61). It has four digits when the
/// uncertainty is 0 or not finite.
std::string rounded(double value, double uncertainty);

/// An estimate as every page and tool writes it: rounded to two digits of half its 95 % interval.
struct ShownEstimate {
  std::string mean, lower, upper;
};
ShownEstimate shown_estimate(const ParameterEstimate& p, double scale);

/// Writes the Young's moduli among parameters, as fits have them: "19.00 kPa"; empty when there is none.
std::string shown_moduli(const std::map<std::string, double>& parameters);

}  // namespace tissue_stiffness
