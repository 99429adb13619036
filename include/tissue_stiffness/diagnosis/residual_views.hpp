#pragma once

#include <string>

#include "tissue_stiffness/diagnosis/study.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// The error by frame, node, size of the motion, frequency and phase.
ResidualViews residual_views(const Study& study, const Study::Rows& rows);

/// In words: where on the body the error is larger than noise ("near x = 0.09 of 0.10 m ...", with the model's region when
/// it lies in one), or that it is as large everywhere.
std::string where_it_fails(const Study& study, const Study::Rows& rows);

/// In words: in which part of the recording, and whether it grows with the motion.
std::string when_it_fails(const Study& study, const Study::Rows& rows);

/// The recording that would tell the effects of a set apart; empty for a set of one.
std::string next_experiment(const std::vector<std::string>& set);

}  // namespace tissue_stiffness
