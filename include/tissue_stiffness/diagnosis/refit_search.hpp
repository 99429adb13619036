#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/refit_list.hpp"

namespace tissue_stiffness {

/// Refits of what the tangents rank highest, best first, one an effect (or pair); of `wanted` ones only, if any. Where the
/// best leaves more than noise the search goes on: other ways and kinds of the leaders, fits that begin with the
/// recording's beginning, pairs. Each stage is one function. Refits run side by side.
/// `so_far` hears of every stage's, also where the search is interrupted.
RefitList search_refits(const FirstLook& look, const std::vector<std::string>& wanted, const DiagnosisOptions& options,
                        const RefitsSoFar& so_far);

}  // namespace tissue_stiffness
