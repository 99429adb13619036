#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tissue_stiffness/fit/recording.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

struct FittedModel;
class RecordingFit;

/// What a diagnosis does, and who hears of it.
struct DiagnosisOptions {
  std::vector<std::string> add;     ///< effects to add in turn, whatever the verdict
  std::vector<std::string> ignore;  ///< effects that are not searched for
  bool automatic = false;           ///< keep adding the best one while the verdict is `missing`
  int most_steps = 3;               ///< of automatic adding
  /// It hears which step begins and, where such steps are counted, how many are over and how many there are.
  std::function<void(const std::string&, std::size_t done, std::size_t total)> progress = [](const std::string&,
                                                                                             std::size_t, std::size_t) {};
  /// It hears what is known so far whenever that is more, marked as interrupted during the step under way.
  std::function<void(const Diagnosis&)> so_far = [](const Diagnosis&) {};
  /// At the end it sees the given model and the last one, which may be one object. It also sees a model on a finer mesh, or
  /// null. It may improve the diagnosis' estimate.
  using End = std::function<void(Diagnosis&, FittedModel& given, FittedModel& last, const RecordingFit* finer)>;
  End at_end = [](Diagnosis&, FittedModel&, FittedModel&, const RecordingFit*) {};
};

/// Compares the fitted model's free run with the recording, and ranks the effects that the library proposes as missing. It
/// refits the best and compares the hypotheses by their evidence. The errors of held-out frames are reported. Throws
/// InputError for a recording too short to hold anything out, or an effect to add that the library does not propose for
/// this model.
///
/// The search ends where the recording's checkpoint throws Interrupted. The diagnosis then holds what is known so far: the
/// fit of the given model and its error, candidates as far as they are ranked and refitted, and the effects added.
Diagnosis diagnose(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                   const DiagnosisOptions& options);

}  // namespace tissue_stiffness
