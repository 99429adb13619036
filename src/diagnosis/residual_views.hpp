#pragma once

#include <string>

#include "fit/recording_fit.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Tabulates the error by frame, node, size of the motion, frequency and phase.
ResidualViews residual_views(const RecordingFit& recording_fit, const RecordingRows& rows);

/// Says where on the body the error is larger than noise, or that it is as large everywhere: "around (90, 10, 10) mm,
/// in region tip: 3.1 sigma rms there, 1.2 over the body". The region is named when the place lies in one.
std::string where_it_fails(const RecordingFit& recording_fit, const RecordingRows& rows);

/// Says in which part of the recording the error lies, and whether it grows with the motion.
std::string when_it_fails(const RecordingFit& recording_fit, const RecordingRows& rows);

/// Returns the recording that would tell the best explanation from the others of the set; empty where there are no others.
std::string next_experiment(const std::vector<std::string>& set, const BestExplanation& best);

}  // namespace tissue_stiffness
