#pragma once

#include <string>

#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Returns the card that says where, when and by how much the given model fails, with the force that it misses. It is empty
/// when nothing was fitted.
std::string failure(const Diagnosis& diagnosis);

/// Returns the folded card with the probability that the models are valid, by place and time; empty when it is unknown.
std::string validity(const Diagnosis& diagnosis);

}  // namespace tissue_stiffness
