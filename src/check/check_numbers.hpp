#pragma once

#include "check/setup_finding.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// Finds numbers of the model file that no material has, and a body that nothing holds.
/// * young_modulus: below 100 Pa it is softer than any tissue or gel that keeps its shape. It is probably in kPa or MPa.
/// * density: below 5 kg/m^3 it is lighter than any foam. It is probably in g/cm^3.
/// * effects: without `fixed`, `elastic_support`, `foundation` or `contact_plane` the body accelerates as a whole.
/// Throws InputError for a value that is not a number or a prior.
SetupFindings check_numbers(const ModelSettings& settings);

}  // namespace tissue_stiffness
