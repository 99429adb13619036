#pragma once

#include <functional>
#include <iosfwd>
#include <string>

namespace tissue_stiffness {

/// A file that is written under another name in the same folder and takes its own when it is whole, so that nobody ever
/// reads half of it, however the process ends. A device or a pipe is written directly.
class PendingFile {
 public:
  explicit PendingFile(std::string file);
  /// Removes what was not put in place.
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write until then.
  const std::string& path() const { return path_; }
  /// Replaces the file that may be there. Throws InputError when that is not possible.
  void put_in_place();

 private:
  std::string file_, path_;
  bool placed_ = false;
};

/// Writes a file whole or not at all: what `write` throws leaves the folder as it was. Throws InputError naming the file
/// when it cannot be written.
void write_file(const std::string& file, const std::function<void(std::ostream&)>& write);

}  // namespace tissue_stiffness
