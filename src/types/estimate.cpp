#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

std::string to_string(EstimateState state) {
  switch (state) {
    case EstimateState::no_data:
      return "no_data";
    case EstimateState::converging:
      return "converging";
    case EstimateState::converged:
      return "converged";
    case EstimateState::doubtful:
      return "doubtful";
    case EstimateState::stale:
      return "stale";
    case EstimateState::drifting:
      return "drifting";
    case EstimateState::model_invalid:
      break;
  }
  return "model_invalid";
}

bool is_young_modulus(const std::string& name) {
  const std::string end = ".young_modulus";
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

}  // namespace tissue_stiffness
