#include "diagnosis/try_run.hpp"

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

bool try_run(const Recording& recording, const std::function<void()>& work, std::string* reason) {
  try {
    work();
    return true;
  } catch (const NumericalError& error) {
    recording.checkpoint();  // a checkpoint that ended the work is no failure of the model
    if (reason != nullptr) *reason = error.what();
    return false;
  }
}

}  // namespace tissue_stiffness
