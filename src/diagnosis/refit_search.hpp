#pragma once

#include <string>
#include <vector>

#include "diagnosis/refit_list.hpp"

namespace tissue_stiffness {

/// Refits what the tangents rank highest. While nothing is judged to be missing the search goes on: with other places and
/// directions of the leaders, and with fits that start from the initial segment. Each stage is one function. Returns true
/// if the given model has moved and nothing explains what it leaves: the library's tangents are then to be taken anew
/// there. Beside another effect the search goes on with what was fitted.
bool search_refits(const Screening& screening, RefitList& refits);

/// Refits all that was screened, in full whatever it promises. Beside another effect it continues with the initial segment
/// while nothing explains the recording.
void refit_effects(const Screening& screening, RefitList& refits);

}  // namespace tissue_stiffness
