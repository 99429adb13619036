#pragma once

#include <string>
#include <vector>

namespace tissue_stiffness {

/// The candidate that `word` is most likely a misspelling of (optimal string alignment distance, at most a third of the
/// word's length), or an empty string.
std::string closest(const std::string& word, const std::vector<std::string>& candidates);

/// "a, b, c", or "nothing" for an empty list.
std::string join(const std::vector<std::string>& words);

/// " (did you mean `x`?)", or an empty string when no candidate is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace tissue_stiffness
