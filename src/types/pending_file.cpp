#include "types/pending_file.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <utility>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

[[noreturn]] void refuse(const std::string& file) {
  throw InputError(file, "a file that cannot be written", "a writable folder");
}

bool is_device(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::is_other(file, ignored);
}

}  // namespace

PendingFile::PendingFile(std::string file)
    : file_(std::move(file)), path_(is_device(file_) ? file_ : file_ + ".part" + std::to_string(getpid())) {}

PendingFile::~PendingFile() {
  if (!placed_ && path_ != file_) std::remove(path_.c_str());
}

void PendingFile::put_in_place() {
  if (path_ != file_ && std::rename(path_.c_str(), file_.c_str()) != 0) refuse(file_);
  placed_ = true;
}

void write_file(const std::string& file, const std::function<void(std::ostream&)>& write) {
  PendingFile pending(file);
  std::ofstream stream(pending.path(), std::ios::binary);
  write(stream);
  stream.close();
  if (!stream) refuse(file);
  pending.put_in_place();
}

}  // namespace tissue_stiffness
