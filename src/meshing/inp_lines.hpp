#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// A keyword line of an input file of Abaqus or CalculiX, in capitals: `*ELEMENT, TYPE=C3D4`.
struct InpKeyword {
  std::string name;                           ///< without its asterisk; words are separated by one blank
  std::map<std::string, std::string> values;  ///< of its parameters, empty for one without
};

/// Reads the lines of such a file without comments (`**`) and empty lines. Every failure is an InputError "mesh file
/// FILE:LINE: found ...; allowed: ...".
class InpLines {
 public:
  /// Reads the whole file. Throws InputError when that is not possible.
  explicit InpLines(std::string file);

  bool at_end() const { return next_.empty(); }
  bool at_keyword() const { return !next_.empty() && next_[0] == '*'; }

  /// Returns the keyword line that is next, which goes on behind a comma at its end.
  InpKeyword keyword();

  /// Returns the `count` fields of the next entry, which goes on in the next line while fields are missing. `what` names
  /// the entry.
  std::vector<std::string> entry(std::size_t count, const std::string& what);

  /// Passes all lines up to the next keyword, and returns how many there are.
  int skip_data();

  long long number_of(const std::string& field, const std::string& what) const;  ///< from 1
  double coordinate_of(const std::string& field, const std::string& what) const;

  /// Refuses the line that was read last.
  [[noreturn]] void fail(const std::string& found, const std::string& allowed) const;

 private:
  std::string take();

  std::string file_, bytes_;
  std::size_t position_ = 0;
  int line_ = 0, next_line_ = 0;  // of what was read last, and of `next_`
  std::string next_;              // without blanks around it; empty at the end
};

}  // namespace tissue_stiffness
