#pragma once

#include <stdexcept>
#include <string>

namespace tissue_stiffness {

/// Wrong input from the user: a file, a key, a topic or a message. The tools print it as one line and exit with code 2;
/// the nodes log it and go on. The text names where, the value found, and what is allowed.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  /// "WHERE: found VALUE; allowed: ALLOWED"
  InputError(const std::string& where, const std::string& value, const std::string& allowed)
      : std::runtime_error(where + ": found " + value + "; allowed: " + allowed) {}
};

/// A computation that could not be finished (a diverging step, a singular matrix). Survivable by the caller.
class NumericalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tissue_stiffness
