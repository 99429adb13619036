#pragma once

#include <string>
#include <vector>

namespace tissue_stiffness {

/// A part of a set-up that is probably wrong, found before anything is estimated.
struct SetupFinding {
  std::string where;     ///< key of the model file, or topic
  std::string sentence;  ///< names `where`, the value, what is allowed and the likely remedy; see doc/check.md
};
using SetupFindings = std::vector<SetupFinding>;

/// Geometric mean of 1 and 1000. A ratio beyond it is nearer to a wrong unit prefix (mm for m, kPa for Pa) than to a right
/// one.
constexpr double kPrefixSlip = 31.6;

inline void append(SetupFindings& to, SetupFindings more) {
  for (SetupFinding& finding : more) to.push_back(std::move(finding));
}

}  // namespace tissue_stiffness
