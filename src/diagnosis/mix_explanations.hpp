#pragma once

#include <vector>

#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Where indistinguishable explanations lead to different moduli, each Young's modulus becomes their mixture:
///   log E ~ sum over explanations of p N(mu + log ratio, sigma^2),
/// with mu and sigma of the added explanation. Mean, standard deviation and 95 % interval are the mixture's. Explanations
/// of different added effects are independent.
void mix_explanations(const std::vector<std::vector<RivalExplanation>>& rivals, std::vector<ParameterEstimate>& parameters);

}  // namespace tissue_stiffness
