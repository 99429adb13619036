#pragma once

#include <string>
#include <vector>

namespace tissue_stiffness {

/// Something in a set-up that is likely to be wrong, found before anything is estimated.
struct SetupFinding {
  std::string where;     ///< key of the model file, or topic
  std::string sentence;  ///< names `where`, the value, what is allowed and the likely mend; doc/check.md lists them all
};
using SetupFindings = std::vector<SetupFinding>;

/// Geometric mean of 1 and 1000: a ratio beyond it is nearer to a slip of a unit prefix (mm for m, kPa for Pa) than to
/// none.
constexpr double kPrefixSlip = 31.6;

inline void append(SetupFindings& to, SetupFindings more) {
  for (SetupFinding& finding : more) to.push_back(std::move(finding));
}

}  // namespace tissue_stiffness
