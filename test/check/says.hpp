#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "check/setup_finding.hpp"

namespace tissue_stiffness {

/// One finding, whose sentence is one line, ends as a sentence does and holds all the words.
inline ::testing::AssertionResult says(const SetupFindings& findings, const std::vector<std::string>& words) {
  if (findings.empty()) return ::testing::AssertionFailure() << "nothing is said";
  if (findings.size() > 1) return ::testing::AssertionFailure() << "more than one: " << findings[1].sentence;
  const std::string& sentence = findings.front().sentence;
  if (sentence.find('\n') != std::string::npos || sentence.back() != '.') {
    return ::testing::AssertionFailure() << "no sentence: " << sentence;
  }
  for (const std::string& word : words) {
    if (sentence.find(word) == std::string::npos)
      return ::testing::AssertionFailure() << "no '" << word << "' in: " << sentence;
  }
  return ::testing::AssertionSuccess();
}

inline ::testing::AssertionResult nothing(const SetupFindings& findings) {
  if (findings.empty()) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << findings.front().sentence;
}

}  // namespace tissue_stiffness
