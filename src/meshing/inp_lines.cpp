#include "meshing/inp_lines.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <utility>

#include "meshing/file_cursor.hpp"
#include "meshing/mesh_limits.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/read_file.hpp"

namespace tissue_stiffness {
namespace {

constexpr const char* kBlanks = " \t\r\f\v";

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < line.size();) {  // what would follow a comma at the end is no field
    const std::size_t comma = std::min(line.find(',', at), line.size());
    out.push_back(trimmed(line.substr(at, comma - at)));
    at = comma + 1;
  }
  return out;
}

// In capitals, with one blank between words.
std::string normal(const std::string& text) {
  std::string out;
  for (const char c : trimmed(text)) {
    const bool blank = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (blank && !out.empty() && out.back() == ' ') continue;
    out += blank ? ' ' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return out;
}

}  // namespace

InpLines::InpLines(std::string file)
    : file_(std::move(file)), bytes_(read_file(file_, "mesh file " + file_, "an existing mesh file", kLargestMeshFile)) {
  take();
  line_ = next_line_;
}

// Returns the next line, and looks for the one behind it.
std::string InpLines::take() {
  std::string taken = std::move(next_);
  next_.clear();
  line_ = next_line_;
  while (position_ < bytes_.size() && next_.empty()) {
    const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
    next_ = trimmed(bytes_.substr(position_, end - position_));
    if (next_.rfind("**", 0) == 0) next_.clear();
    position_ = end + 1;
    ++next_line_;
  }
  return taken;
}

InpKeyword InpLines::keyword() {
  std::string text = take();
  if (text.empty() || text[0] != '*') fail(printable(text), "a keyword that begins with * (Abaqus, CalculiX)");
  while (text.back() == ',' && !at_end() && !at_keyword()) text += take();
  const std::vector<std::string> fields = fields_of(text.substr(1));
  InpKeyword out;
  if (!fields.empty()) out.name = normal(fields[0]);
  for (std::size_t i = 1; i < fields.size(); ++i) {
    const std::size_t equals = std::min(fields[i].find('='), fields[i].size());
    const std::string value = equals < fields[i].size() ? fields[i].substr(equals + 1) : "";
    out.values[normal(fields[i].substr(0, equals))] = normal(value);
  }
  return out;
}

std::vector<std::string> InpLines::entry(std::size_t count, const std::string& what) {
  std::vector<std::string> out;
  while (out.size() < count) {
    if (at_end() || at_keyword()) {
      fail(std::to_string(out.size()) + " numbers", std::to_string(count) + " numbers (" + what + ")");
    }
    for (std::string& field : fields_of(take())) out.push_back(std::move(field));
  }
  if (out.size() > count) {
    fail(std::to_string(out.size()) + " numbers", std::to_string(count) + " numbers (" + what + ")");
  }
  return out;
}

int InpLines::skip_data() {
  int count = 0;
  for (; !at_end() && !at_keyword(); ++count) take();
  return count;
}

long long InpLines::number_of(const std::string& field, const std::string& what) const {
  char* end = nullptr;
  errno = 0;
  const long long value = std::strtoll(field.c_str(), &end, 10);
  if (field.empty() || end != field.c_str() + field.size() || errno != 0 || value < 1) {
    fail(printable(field), "a whole number from 1 (" + what + ")");
  }
  return value;
}

double InpLines::coordinate_of(const std::string& field, const std::string& what) const {
  std::string text = field;
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');  // Fortran's exponent
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size()) fail(printable(field), "a number (" + what + ")");
  return value;
}

void InpLines::fail(const std::string& found, const std::string& allowed) const {
  throw InputError("mesh file " + file_ + ":" + std::to_string(std::max(line_, 1)), found, allowed);
}

}  // namespace tissue_stiffness
