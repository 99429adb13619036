#pragma once

#include <functional>
#include <iosfwd>
#include <string>

namespace tissue_stiffness {

/// A file that is written under a temporary name in the same folder and renamed when it is complete. So no reader ever sees
/// half a file, however the process ends. A device or a pipe is written directly.
class PendingFile {
 public:
  explicit PendingFile(std::string file);
  /// Removes the temporary file if it was not put in place.
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Path to write to until put_in_place() is called.
  const std::string& path() const { return path_; }
  /// Renames the temporary file and so replaces a file that may exist. Throws InputError when that is not possible.
  void put_in_place();

 private:
  std::string file_, path_;
  bool placed_ = false;
};

/// Writes a file completely or not at all: if `write` throws, the folder stays as it was. Throws InputError naming the file
/// when it cannot be written.
void write_file(const std::string& file, const std::function<void(std::ostream&)>& write);

}  // namespace tissue_stiffness
