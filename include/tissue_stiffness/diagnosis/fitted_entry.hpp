#pragma once

#include <string>

#include "tissue_stiffness/estimation/batch_fit.hpp"

namespace tissue_stiffness {

/// `entry`, "name: {key: value, ...}" of the model file, with every estimated quantity of the effect with this label
/// replaced by a prior around its fit, five posterior standard deviations wide.
std::string fitted_entry(std::string entry, const std::string& label, const Model& model, const BatchFit& fit);

}  // namespace tissue_stiffness
