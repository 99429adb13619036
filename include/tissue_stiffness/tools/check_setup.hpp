#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include "tissue_stiffness/check/setup_finding.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {

/// What is wrong with a model file and, where one is given, a recording for it. From what costs nothing to what takes a run
/// of the model; each step only where those before found nothing that would mislead it. Throws InputError for what cannot
/// be read, unless a finding says why. `checkpoint` is called before every frame that is read; what it throws ends the
/// check.
SetupFindings check_setup(
    const ModelSettings& settings, const std::string& recording = "", const std::function<void()>& checkpoint = [] {});

/// The same before a tool's own work: sentences as warnings, "TOOL: warning: SENTENCE". Throws Interrupted from
/// `checkpoint` and nothing else: what makes the run impossible is the run's to say.
void warn_of_setup(const std::string& tool, const ModelSettings& settings, const std::string& recording,
                   const std::function<void()>& checkpoint, std::ostream& out);

}  // namespace tissue_stiffness
