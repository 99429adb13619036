#pragma once

#include "fit/recording_fit.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Returns an estimator's result for the last model. For a model that is integrated in full it returns the fit's result,
/// because the estimator would take as long as the diagnosis. The arguments are those of DiagnosisOptions::End.
Estimate estimate_at_last(const Diagnosis& diagnosis, const FittedModel& given, const FittedModel& last,
                          const RecordingFit* finer);

}  // namespace tissue_stiffness
