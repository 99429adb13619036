#pragma once

#include "tissue_stiffness/types/stop_request.hpp"

namespace tissue_stiffness {

/// From now on the first SIGINT or SIGTERM makes the returned request, the only one of the process; the second ends the
/// process at once with exit code 75. To be called before anything that takes time.
StopRequest& stop_on_signals();

}  // namespace tissue_stiffness
