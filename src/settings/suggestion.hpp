#pragma once

#include <string>
#include <vector>

namespace tissue_stiffness {

/// Returns the candidate of which `word` is most likely a misspelling, or an empty string. The optimal string alignment
/// distance is at most a third of the word's length, and 1 for shorter words.
std::string closest_word(const std::string& word, const std::vector<std::string>& candidates);

/// Returns "a, b, c", or "nothing" for an empty list.
std::string join_words(const std::vector<std::string>& words);

/// Returns " (did you mean `x`?)", or an empty string when no candidate is similar.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace tissue_stiffness
