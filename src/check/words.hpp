#pragma once

#include <string>

#include "report/text.hpp"

namespace tissue_stiffness {

/// Formats a number for a sentence: at most `digits` significant digits, without trailing zeros in its decimals.
inline std::string plain_number(double value, int digits = 3) {
  std::string text = short_number(value, digits);
  if (text.find('.') == std::string::npos || text.find('e') != std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

inline std::string millimetres(double metres) {
  return plain_number(1e3 * metres) + " mm";
}

}  // namespace tissue_stiffness
