#pragma once

#include <string>
#include <vector>

namespace tissue_stiffness {

/// A chart of one quantity over time, as HTML with an inline SVG that stretches while its labels keep their size.
struct Chart {
  std::string title;
  std::string unit;           ///< of y
  std::vector<double> time;   ///< ascending [s]
  std::vector<double> line;   ///< NaN: a gap
  std::vector<double> lower;  ///< band, or empty
  std::vector<double> upper;
  std::string line_name, band_name;
  double reference = 0.0;  ///< a dashed level, where reference_name is not empty
  std::string reference_name;
  std::vector<double> skipped;  ///< times marked on the lower edge [s]
  bool from_zero = false;       ///< the axis starts at zero

  std::string html() const;
};

/// Ticks at multiples of 1, 2 or 5 times a power of ten inside [low, high], about `count` of them.
std::vector<double> linear_ticks(double low, double high, int count);

/// Ticks at 1, 2, 5 times powers of ten inside [low, high], or at powers of ten only over more than two decades.
std::vector<double> log_ticks(double low, double high);

}  // namespace tissue_stiffness
