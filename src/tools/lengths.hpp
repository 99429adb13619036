#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "report/text.hpp"

namespace tissue_stiffness {

/// Writes the lengths of one line or column with three digits, all in the unit that suits the largest of them.
class Lengths {
 public:
  explicit Lengths(const std::vector<double>& metres) {
    double largest = 0.0;
    for (const double length : metres) {
      if (std::isfinite(length)) largest = std::max(largest, std::abs(length));
    }
    unit_ = shown_unit(largest, "m");
  }

  const std::string& unit() const { return unit_.name; }
  std::string operator()(double metres) const { return short_number(unit_.scale * metres, 3); }

 private:
  ShownUnit unit_;
};

}  // namespace tissue_stiffness
