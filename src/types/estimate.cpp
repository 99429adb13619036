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
    case EstimateState::drifting:
      return "drifting";
    case EstimateState::model_invalid:
      break;
  }
  return "model_invalid";
}

}  // namespace tissue_stiffness
