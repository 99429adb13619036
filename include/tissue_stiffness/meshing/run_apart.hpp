#pragma once

#include <functional>
#include <optional>
#include <string>

namespace tissue_stiffness {

/// Runs `work` in a child process, silent, and returns the bytes that it returns; nothing when the child crashed, threw, or
/// took longer than `seconds`. For libraries that may take the whole process down.
std::optional<std::string> run_apart(const std::function<std::string()>& work, unsigned seconds);

}  // namespace tissue_stiffness
