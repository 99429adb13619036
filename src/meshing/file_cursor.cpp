#include "meshing/file_cursor.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>

#include "meshing/mesh_limits.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/read_file.hpp"

namespace tissue_stiffness {
namespace {

bool is_space(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

}  // namespace

std::string printable(const std::string& text) {
  std::string shown = "'" + text.substr(0, 32) + "'";
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return std::isprint(static_cast<unsigned char>(c)) == 0; }, '?');
  return shown;
}

FileCursor::FileCursor(const std::string& file)
    : file_(file), bytes_(read_file(file, "mesh file " + file, "an existing mesh file", kLargestMeshFile)) {
  if (bytes_.empty()) throw InputError("mesh file " + file, "an empty file", "a mesh");
}

void FileCursor::skip_space() {
  while (position_ < bytes_.size() && is_space(bytes_[position_])) ++position_;
}

bool FileCursor::at_end() {
  skip_space();
  return position_ == bytes_.size();
}

std::string FileCursor::peek() const {
  std::size_t begin = position_;
  while (begin < bytes_.size() && is_space(bytes_[begin])) ++begin;
  std::size_t end = begin;
  while (end < bytes_.size() && !is_space(bytes_[end])) ++end;
  return bytes_.substr(begin, end - begin);
}

std::string FileCursor::word() {
  const std::string text = peek();
  skip_space();
  if (text.empty()) fail("the end of the file", "more data");
  position_ += text.size();
  return text;
}

std::string FileCursor::line() {
  const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
  std::string text = bytes_.substr(position_, end - position_);
  position_ = std::min(end + 1, bytes_.size());
  if (!text.empty() && text.back() == '\r') text.pop_back();
  return text;
}

void FileCursor::skip_comments(char mark) {
  while (!at_end() && bytes_[position_] == mark) line();
}

double FileCursor::number(const std::string& what) {
  const std::string text = word();
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size()) fail(printable(text), "a number (" + what + ")");
  return value;
}

long long FileCursor::integer(const std::string& what, long long lower, long long upper) {
  const std::string text = word();
  char* end = nullptr;
  errno = 0;
  const long long value = std::strtoll(text.c_str(), &end, 10);
  if (end != text.c_str() + text.size() || errno != 0 || value < lower || value > upper) {
    fail(printable(text), what + " from " + std::to_string(lower) + " to " + std::to_string(upper));
  }
  return value;
}

void FileCursor::require(long long count, std::size_t bytes, const std::string& what) const {
  const std::size_t left = bytes_.size() - position_;
  if (static_cast<unsigned long long>(count) <= left / bytes + 1) return;  // the last one needs no separator behind it
  fail("only " + std::to_string(left) + " more bytes", std::to_string(count) + " entries (" + what + ")");
}

const char* FileCursor::binary(std::size_t count, const std::string& what) {
  if (count > bytes_.size() - position_) fail("the end of the file", std::to_string(count) + " bytes of " + what);
  const char* data = bytes_.data() + position_;
  position_ += count;
  return data;
}

void FileCursor::fail(const std::string& found, const std::string& allowed) const {
  const auto lines = std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(position_), '\n');
  throw InputError("mesh file " + file_ + ":" + std::to_string(lines + 1), found, allowed);
}

}  // namespace tissue_stiffness
