#pragma once

#include <functional>
#include <optional>
#include <string>

namespace tissue_stiffness {

/// Runs `work` in a child process without output and returns its bytes. Returns nothing when the child crashed, threw, or
/// took longer than `seconds`. It is for libraries that may crash the whole process. `checkpoint` is called ten times a
/// second; an exception from it ends the child.
std::optional<std::string> run_apart(
    const std::function<std::string()>& work, unsigned seconds, const std::function<void()>& checkpoint = [] {});

}  // namespace tissue_stiffness
