#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/study.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

struct DiagnosisOptions {
  std::vector<std::string> add;     ///< effects to add in turn, whatever the verdict
  std::vector<std::string> ignore;  ///< effects that are not looked for
  bool automatic = false;           ///< keep adding the best while the held-out error proves it
  int most_steps = 3;               ///< of automatic adding
  /// What begins; where such steps are counted, how many of them are over and how many there are.
  std::function<void(const std::string&, std::size_t done, std::size_t total)> progress = [](const std::string&,
                                                                                             std::size_t, std::size_t) {};
  /// Hears of what is known so far whenever that is more, marked as interrupted during the step under way.
  std::function<void(const Diagnosis&)> so_far = [](const Diagnosis&) {};
  /// Sees the given model and the last one, which may be the same, when all is said; and a model on a finer mesh, or null.
  /// May better the diagnosis' estimate.
  using End = std::function<void(Diagnosis&, Fitted& given, Fitted& last, const Study* finer)>;
  End at_end = [](Diagnosis&, Fitted&, Fitted&, const Study*) {};
};

/// Compares the fitted model's free run with the recording, ranks what the library offers as missing, proves the best by
/// refitting it and looking at held-out frames. Throws InputError for a recording too short to hold anything out, or an
/// effect to add that the library does not propose for this model.
///
/// Where the recording's checkpoint throws Interrupted the search ends, and the diagnosis holds what is known by then: the
/// fit of the given model and its error, candidates as far as they are ranked and refitted, effects added so far.
Diagnosis diagnose(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
                   const DiagnosisOptions& options);

}  // namespace tissue_stiffness
