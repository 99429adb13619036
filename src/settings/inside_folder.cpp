#include "settings/inside_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

namespace fs = std::filesystem;

std::string path_from(const std::string& directory, const std::string& file) {
  if (file.empty() || file.front() == '/' || directory.empty()) return file;
  return directory.back() == '/' ? directory + file : directory + "/" + file;
}

std::string require_inside(const std::string& file, const std::string& folder, const std::string& where,
                           const std::string& or_else) {
  std::error_code failed;
  const fs::path root = fs::weakly_canonical(folder.empty() ? fs::path(".") : fs::path(folder), failed);
  const fs::path path = fs::weakly_canonical(root / file, failed);  // an absolute file replaces the root
  const auto end = std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first;
  if (failed || end != root.end() || path == root) {
    throw InputError(where, file, "a file in the folder " + root.string() + or_else);
  }
  return path.string();
}

// The copy is asked, so that keys which nobody knows stay unread.
void require_files_inside(Value model, const std::string& folder, const std::string& or_else) {
  if (model.type() == Value::Type::list) {
    for (const Value& item : model.items()) require_files_inside(item, folder, or_else);
  }
  if (model.type() != Value::Type::map) return;
  for (const std::string& key : model.keys()) {
    const Value& entry = model.at(key);
    if (key == "file" && entry.type() == Value::Type::text) {
      require_inside(entry.as_text(), folder, entry.path(), or_else);
    } else {
      require_files_inside(entry, folder, or_else);
    }
  }
}

void require_files_inside(const std::string& yaml_file, const std::string& or_else) {
  require_files_inside(load_yaml(yaml_file), fs::absolute(yaml_file).parent_path().string(), or_else);
}

}  // namespace tissue_stiffness
