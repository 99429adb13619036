#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/types/diagnosis.hpp"
#include "types/replay.hpp"

namespace tissue_stiffness {

/// Texts that a diagnosis' report shows in addition to the diagnosis.
struct DiagnosisTexts {
  std::string model, recording, command_line;  ///< names as given
  std::string model_text, next_model_text;     ///< content of the model files
  std::vector<std::pair<std::string, std::string>> versions;
  std::map<std::string, std::string> units;  ///< of the parameters of effects, by EFFECT.PARAMETER
};

/// Returns `diagnosis.json`: complete, interrupted_during (if it is not complete), verdict, set, probability_adequate,
/// none_of_these, z, best, candidates[], where, when, how_much, residual, steps[], next_experiment, final. `final.rivals[]`
/// are the explanations that the data cannot distinguish from an added one. `final.traces[]` are effects that may act in
/// addition without being missed. The moduli in `final` are the mixture. A number that does not exist is null. Everything
/// except `seconds` depends only on the input.
std::string diagnosis_json(const Diagnosis& diagnosis);

/// Returns `report.html`, one page that needs no network, as report_html does.
std::string diagnosis_html(const Diagnosis& diagnosis, const DiagnosisTexts& texts, const Showing& showing);

/// Writes model_next.yaml, report.html and, last, diagnosis.json, each completely or not at all. Makes the folder when it
/// is missing. Throws InputError when a file cannot be written.
void write_diagnosis(const Diagnosis& diagnosis, const DiagnosisTexts& texts, const Showing& showing,
                     const std::string& directory);

/// Returns a summary for the reader: what is missing, what it would explain, and what fits as well. A page that lists the
/// probabilities of the effects does without those in the sentence.
std::string diagnosis_sentence(const Diagnosis& diagnosis, bool with_probabilities = true);

}  // namespace tissue_stiffness
