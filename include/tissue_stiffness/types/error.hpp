#pragma once

#include <stdexcept>
#include <string>

namespace tissue_stiffness {

/// The user's input is wrong: a file, a key, a topic or a message. The tools print the error as one line and exit with code
/// 2; the nodes log it and continue. The text says where the error is, which value was found, and what is allowed. What is
/// long is cut, and control characters are replaced.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& text);
  /// The text becomes "WHERE: found VALUE; allowed: ALLOWED".
  InputError(const std::string& where, const std::string& value, const std::string& allowed);
};

/// A computation could not be finished (a diverging step, a singular matrix). The caller can recover from it.
class NumericalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tissue_stiffness
