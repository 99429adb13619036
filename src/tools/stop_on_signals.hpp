#pragma once

#include "types/stop_request.hpp"

namespace tissue_stiffness {

/// From now on the first SIGINT or SIGTERM triggers the returned request, which is the only one of the process. The second
/// signal ends the process immediately with exit code 75. It must be called before anything that takes time.
StopRequest& stop_on_signals();

}  // namespace tissue_stiffness
