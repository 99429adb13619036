#include "tissue_stiffness/types/diagnosis.hpp"

#include <algorithm>
#include <iterator>

namespace tissue_stiffness {

std::vector<std::string> others_in_set(const std::vector<std::string>& set, const BestExplanation& best) {
  std::vector<std::string> others;
  std::copy_if(set.begin(), set.end(), std::back_inserter(others), [&](const std::string& effect) {
    return std::count(best.effects.begin(), best.effects.end(), effect) == 0;
  });
  return others;
}

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::unfinished:
      break;
    case Verdict::adequate:
      return "adequate";
    case Verdict::missing:
      return "missing";
    case Verdict::numerics:
      return "numerics";
    case Verdict::unexplained:
      return "unexplained";
  }
  return "unfinished";
}

}  // namespace tissue_stiffness
