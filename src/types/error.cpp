#include "tissue_stiffness/types/error.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

constexpr std::size_t kLongestPart = 300, kLongest = 4000;  // characters

bool continues_character(char c) {  // of UTF-8
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

// Text of a broken file may be long, and its control characters would disturb a terminal.
std::string shown(std::string text, std::size_t longest) {
  if (text.size() > longest) {
    const std::size_t whole = text.size();
    text.resize(longest);
    while (!text.empty() && continues_character(text.back())) text.pop_back();
    if (!text.empty() && (static_cast<unsigned char>(text.back()) & 0x80U) != 0U) text.pop_back();  // its first byte
    text += "... (" + std::to_string(whole) + " characters)";
  }
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (c >= 0 && c < ' ' && c != '\n') || c == '\x7f'; }, '?');
  return text;
}

}  // namespace

InputError::InputError(const std::string& text) : std::runtime_error(shown(text, kLongest)) {}

InputError::InputError(const std::string& where, const std::string& value, const std::string& allowed)
    : std::runtime_error(shown(where, kLongestPart) + ": found " + shown(value, kLongestPart) +
                         "; allowed: " + shown(allowed, kLongest)) {}

}  // namespace tissue_stiffness
