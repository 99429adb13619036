#pragma once

#include "tissue_stiffness/check/setup_finding.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// Numbers of the model file that no matter has, and a body that nothing holds:
///   young_modulus  below 100 Pa, softer than any tissue or gel that keeps its shape: probably kPa or MPa
///   density        below 5 kg/m^3, lighter than any foam: probably g/cm^3
///   effects        without `fixed`, `elastic_support`, `foundation` or `contact_plane` the body accelerates as a whole
/// Throws InputError for a value that is no number or prior.
SetupFindings check_numbers(const ModelSettings& settings);

}  // namespace tissue_stiffness
