#pragma once

#include <functional>
#include <string>

#include "tissue_stiffness/fit/recording.hpp"

namespace tissue_stiffness {

/// Does work that runs models of a recording. Returns false, and gives the `reason`, where a model cannot be run: such a
/// model explains nothing. Throws Interrupted if the recording's checkpoint has ended the diagnosis.
bool try_run(const Recording& recording, const std::function<void()>& work, std::string* reason = nullptr);

}  // namespace tissue_stiffness
