#pragma once

#include <string>
#include <vector>

#include "diagnosis/finding.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Describes a model that has these effects more than the given one: its parameters and its errors, as it is compared.
DiagnosisStep describe_step(const FittedModel& model, const Explained& explained, const std::vector<std::string>& effects);

/// Writes where and when the model's residual is large, and its parts. What the mesh changes is not known yet.
void describe_residual(const FittedModel& model, Diagnosis& out);

/// Returns what the most probable hypothesis that names any effect explains of the model's residual.
BestExplanation best_explanation(const FittedModel& model, const Comparison& comparison);

/// Returns the other explanations of the set, by their shares of its probability.
std::vector<RivalExplanation> rivals_of(const Finding& finding, const Refit& added);

/// Returns what else may act, by what it would do to the last model's moduli.
std::vector<RivalExplanation> traces_of(const Finding& finding, const FittedModel& last);

}  // namespace tissue_stiffness
