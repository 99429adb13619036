#include "tools/manifest.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>

#include "settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/read_text.hpp"
#include "tools/versions.hpp"
#include "types/csv.hpp"
#include "types/formatted.hpp"
#include "types/read_file.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestFile = 100'000'000;  // [byte]

/// FNV-1a: Fowler, Noll & Vo, http://www.isthe.com/chongo/tech/comp/fnv.
class Hash {
 public:
  void add(const char* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ static_cast<unsigned char>(data[i])) * 0x100000001b3u;
  }
  // The length goes before the text, so that no two lists of texts are the same bytes.
  void add(const std::string& text) {
    const std::string size = std::to_string(text.size()) + ":";
    add(size.data(), size.size());
    add(text.data(), text.size());
  }
  void add_file(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    add(stream ? "file" : "no file");
    std::vector<char> block(1 << 20);
    while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0) {
      add(block.data(), static_cast<std::size_t>(stream.gcount()));
    }
  }
  std::string text() const { return formatted("%016llx", static_cast<unsigned long long>(value_)); }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

void add_model(Hash& hash, const std::string& file) {
  hash.add_file(file);
  try {
    extend_model(read_text(file), {}, fs::absolute(file).parent_path().string(), [&](const std::string& named) {
      hash.add_file(named);
      const fs::path path(named);
      if (path.extension() == ".node") hash.add_file(fs::path(path).replace_extension(".ele").string());
      return named;
    });
  } catch (const InputError&) {  // its text says all; `estimate` will say what is wrong
  }
}

}  // namespace

Manifest read_manifest(const std::string& file) {
  const std::string what = "a CSV file with the columns model and recording";
  Manifest out;
  for (std::vector<std::string>& cells : split_csv(read_file(file, file, what, kLargestFile))) {
    if (out.columns.empty()) {
      out.columns = std::move(cells);
      continue;
    }
    const std::string where = file + ": row " + std::to_string(out.rows.size() + 1);
    if (cells.size() != out.columns.size()) {
      throw InputError(where, std::to_string(cells.size()) + " cells", std::to_string(out.columns.size()));
    }
    out.rows.push_back({std::move(cells), "", ""});
  }
  const auto column = [&](const std::string& name) {
    const auto at = std::find(out.columns.begin(), out.columns.end(), name);
    if (at == out.columns.end()) throw InputError(file, "no column " + name, what);
    return static_cast<std::size_t>(at - out.columns.begin());
  };
  const std::size_t model = column("model"), recording = column("recording");
  if (out.rows.empty()) throw InputError(file, "no row below the header", "at least one");
  const fs::path folder = fs::path(file).parent_path();
  for (ManifestRow& row : out.rows) {
    row.model_file = (folder / row.cells[model]).string();
    row.recording_file = (folder / row.cells[recording]).string();
  }
  return out;
}

std::string result_folder(const ManifestRow& row, const std::vector<std::string>& arguments) {
  Hash hash;
  for (const auto& [name, version] : versions()) hash.add(name + " " + version);
  for (const std::string& argument : arguments) hash.add(argument);
  add_model(hash, row.model_file);
  hash.add_file(row.recording_file);
  return fs::path(row.recording_file).stem().string() + "-" + hash.text();
}

std::string csv_row(const std::vector<std::string>& cells) {
  std::string out;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) out += ',';
    out += csv_field(cells[i]);
  }
  return out + "\n";
}

}  // namespace tissue_stiffness
