#pragma once

#include "tissue_stiffness/nodes/messages.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// `added` is left to the caller.
DiagnosisMessage to_message(const Diagnosis& diagnosis, const std_msgs::Header& header);

}  // namespace tissue_stiffness
