#pragma once

#include <optional>

#include "diagnosis/finding.hpp"

namespace tissue_stiffness {

/// Several effects may be missing, of which none explains the error alone. Each of the best refits of `finding` that
/// explains a part of the error is taken for one of them, and what is found beside it is compared with the rest. Effects
/// are exchanged until all were tried in the place of the best pair's leader. `finding` then holds the comparison of all
/// sets, and the most probable effect leads its refits. Returns what was found beside that effect; nothing where no set
/// explains the recording, or where one effect does.
std::optional<Finding> search_pairs(const FittedModel& model, Finding& finding, const Recording& recording,
                                    const DiagnosisOptions& options);

}  // namespace tissue_stiffness
