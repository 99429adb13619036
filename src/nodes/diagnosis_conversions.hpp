#pragma once

#include "nodes/messages.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// Converts a diagnosis to its message. The caller must fill in `added`.
DiagnosisMessage to_message(const Diagnosis& diagnosis, const std_msgs::Header& header);

}  // namespace tissue_stiffness
