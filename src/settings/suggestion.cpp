#include "settings/suggestion.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace tissue_stiffness {
namespace {

/// Counts the insertions, deletions, substitutions and swaps of neighbours that turn a into b.
int alignment_distance(const std::string& a, const std::string& b) {
  const auto rows = static_cast<Eigen::Index>(a.size()), columns = static_cast<Eigen::Index>(b.size());
  Eigen::MatrixXi d(rows + 1, columns + 1);
  for (Eigen::Index i = 0; i <= rows; ++i) d(i, 0) = static_cast<int>(i);
  for (Eigen::Index j = 0; j <= columns; ++j) d(0, j) = static_cast<int>(j);
  const auto at = [](const std::string& s, Eigen::Index i) { return s[static_cast<std::size_t>(i)]; };
  for (Eigen::Index i = 1; i <= rows; ++i) {
    for (Eigen::Index j = 1; j <= columns; ++j) {
      const int substitution = at(a, i - 1) == at(b, j - 1) ? 0 : 1;
      d(i, j) = std::min({d(i - 1, j) + 1, d(i, j - 1) + 1, d(i - 1, j - 1) + substitution});
      if (i > 1 && j > 1 && at(a, i - 1) == at(b, j - 2) && at(a, i - 2) == at(b, j - 1)) {
        d(i, j) = std::min(d(i, j), d(i - 2, j - 2) + 1);
      }
    }
  }
  return d(rows, columns);
}

}  // namespace

std::string closest_word(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  int best_distance = std::max(1, static_cast<int>(word.size()) / 3) + 1;
  for (const std::string& candidate : candidates) {
    const int distance = alignment_distance(word, candidate);
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string join_words(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "nothing" : text;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string near = closest_word(word, candidates);
  return near.empty() ? "" : " (did you mean `" + near + "`?)";
}

}  // namespace tissue_stiffness
