#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/estimation/batch_fit.hpp"

namespace tissue_stiffness {

/// Replaces every estimated quantity of `entries`, "name: {key: value, ...}" each, by a prior around its fit, five
/// posterior standard deviations wide. They are the model's last effects, in order.
void fit_entries(std::vector<std::string>& entries, const Model& model, const BatchFit& fit);

}  // namespace tissue_stiffness
