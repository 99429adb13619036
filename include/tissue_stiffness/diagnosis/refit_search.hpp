#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/refit_list.hpp"

namespace tissue_stiffness {

/// Refits what the tangents rank highest; `wanted` effects only, if there are any. While nothing is judged to be
/// missing the search goes on: other places and directions of the leaders, and fits that begin with the recording's first
/// frames. Each stage is one function. True if the look's base has moved and nothing explains what it leaves: the library's
/// tangents are to be taken anew there.
bool search_refits(const FirstLook& look, const std::vector<std::string>& wanted, RefitList& refits);

}  // namespace tissue_stiffness
