#pragma once

#include <string>

namespace tissue_stiffness {

/// Colours for a terminal. Text is plain in a file or a pipe, on a terminal without colours, and if NO_COLOR is set
/// (no-color.org).
class Paint {
 public:
  explicit Paint(bool on) : on_(on) {}
  /// Returns the colours that suit standard output.
  static Paint for_stdout();

  std::string bold(const std::string& text) const { return in("1", text); }
  std::string good(const std::string& text) const { return in("32", text); }
  std::string warning(const std::string& text) const { return in("33", text); }
  std::string bad(const std::string& text) const { return in("31", text); }

 private:
  std::string in(const char* code, const std::string& text) const;
  bool on_;
};

}  // namespace tissue_stiffness
