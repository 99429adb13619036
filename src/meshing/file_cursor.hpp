#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <sstream>
#include <string>

namespace tissue_stiffness {

/// Returns "(x, y, z) m" for messages.
inline std::string format_point(const Eigen::Vector3d& p) {
  std::ostringstream out;
  out << "(" << p.x() << ", " << p.y() << ", " << p.z() << ") m";
  return out.str();
}

/// Returns the beginning of a text in quotes, without what cannot be printed: words of a binary file in a message must not
/// disturb the terminal.
std::string printable(const std::string& text);

/// Reads the bytes of a file word by word. Every failure is an InputError "FILE:LINE: found ...; allowed: ...".
class FileCursor {
 public:
  /// Reads the whole file. Throws InputError when that is not possible.
  explicit FileCursor(const std::string& file);

  const std::string& bytes() const { return bytes_; }
  std::size_t position() const { return position_; }
  bool at_end();                  ///< skips white space first
  std::string word();             ///< next word; throws at the end of the file
  std::string peek() const;       ///< next word without advancing; empty at the end
  std::string line();             ///< rest of the line, without its end
  void skip_comments(char mark);  ///< skips white space, and from `mark` to the end of its line

  double number(const std::string& what);
  long long integer(const std::string& what, long long lower, long long upper);

  /// Fails unless the rest of the file may hold `count` entries of so many bytes at least. A count is checked by it before
  /// memory is taken, so that a wrong count costs none.
  void require(long long count, std::size_t bytes, const std::string& what) const;

  /// Returns `count` bytes of binary data at the present position.
  const char* binary(std::size_t count, const std::string& what);

  [[noreturn]] void fail(const std::string& found, const std::string& allowed) const;

 private:
  void skip_space();

  std::string file_;
  std::string bytes_;
  std::size_t position_ = 0;
};

}  // namespace tissue_stiffness
