#pragma once

#include <vector>

#include "fit/batch_fit.hpp"
#include "settings/effect_entry.hpp"

namespace tissue_stiffness {

/// Replaces every prior of `entries` by one around its fit, five posterior standard deviations wide. The entries are the
/// model's last effects, in order.
void fit_entries(std::vector<EffectEntry>& entries, const Model& model, const BatchFit& fit);

}  // namespace tissue_stiffness
