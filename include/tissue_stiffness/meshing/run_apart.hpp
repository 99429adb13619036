#pragma once

#include <functional>
#include <optional>
#include <string>

namespace tissue_stiffness {

/// Runs `work` in a child process, silent, and returns the bytes that it returns; nothing when the child crashed, threw, or
/// took longer than `seconds`. For libraries that may take the whole process down. `checkpoint` is called ten times a
/// second; what it throws ends the child.
std::optional<std::string> run_apart(
    const std::function<std::string()>& work, unsigned seconds, const std::function<void()>& checkpoint = [] {});

}  // namespace tissue_stiffness
