#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/types/diagnosis.hpp"
#include "tissue_stiffness/types/replay.hpp"

namespace tissue_stiffness {

/// What a diagnosis is about, for its report.
struct DiagnosisTexts {
  std::string model, recording, command_line;  ///< names as given
  std::string model_text, next_model_text;     ///< the model files
  std::vector<std::pair<std::string, std::string>> versions;
};

/// `diagnosis.json`: complete, interrupted_during (where it is not), verdict, set, probability_adequate, none_of_these, z,
/// best, candidates[], where, when, how_much, residual, steps[], next_experiment, final. `final.rivals[]` are the
/// explanations that the data do not tell from an added one, `final.traces[]` what may act besides without being missed:
/// `final`'s moduli are the mixture. A number that does not exist is null. Everything but `seconds` is the same for the
/// same input.
std::string diagnosis_json(const Diagnosis& diagnosis);

/// `report.html`: one page that needs no network; as report_html.
std::string diagnosis_html(const Diagnosis& diagnosis, const DiagnosisTexts& texts, const Showing& showing);

/// Makes the folder when it is missing and writes model_next.yaml, report.html and, last, diagnosis.json, each whole.
/// Throws InputError when one cannot be written.
void write_diagnosis(const Diagnosis& diagnosis, const DiagnosisTexts& texts, const Showing& showing,
                     const std::string& directory);

/// One sentence for people: what is missing, what it would explain, what looks the same.
std::string diagnosis_sentence(const Diagnosis& diagnosis);

}  // namespace tissue_stiffness
