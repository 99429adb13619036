#pragma once

#include "estimation/reuse_sources.hpp"
#include "fit/recording_fit.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Returns an estimator's result for a model of the recording's body over these frames. `near` is explained at
/// Estimator::replay.
Estimate estimate_by_filter(const ModelSettings& settings, const RecordingFit& recording_fit,
                            const std::vector<Frame>& frames, const Estimate* near = nullptr,
                            const ReuseSources& relatives = {});

/// Returns an estimator's result for the last model. For a model that is integrated in full it returns the fit's result,
/// because the estimator would take as long as the diagnosis. The arguments are those of DiagnosisOptions::End.
Estimate estimate_at_last(const Diagnosis& diagnosis, const FittedModel& given, const FittedModel& last,
                          const RecordingFit* finer);

}  // namespace tissue_stiffness
