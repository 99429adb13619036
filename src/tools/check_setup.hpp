#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include "check/setup_finding.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// Finds errors in a model file and, if one is given, in a recording for it. The checks go from cheap ones to those that
/// run the model. Each step is done only if the earlier ones found nothing that would mislead it. Throws InputError for
/// what cannot be read, unless a finding says why. `checkpoint` is called before every frame that is read; an exception
/// from it ends the check.
SetupFindings check_setup(
    const ModelSettings& settings, const std::string& recording = "", const std::function<void()>& checkpoint = [] {});

/// Runs check_setup before a tool's own work and prints its sentences as warnings, "TOOL: warning: SENTENCE". Throws only
/// Interrupted, from `checkpoint`. Other errors are left to the run, which reports them itself.
void warn_of_setup(const std::string& tool, const ModelSettings& settings, const std::string& recording,
                   const std::function<void()>& checkpoint, std::ostream& out);

}  // namespace tissue_stiffness
