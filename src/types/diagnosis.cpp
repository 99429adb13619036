#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

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
