#include "settings/inside_folder.hpp"

#include <algorithm>
#include <filesystem>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

std::string require_inside(const std::string& file, const std::string& folder, const std::string& where) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path root = fs::weakly_canonical(folder.empty() ? fs::path(".") : fs::path(folder), failed);
  const fs::path path = fs::weakly_canonical(root / file, failed);  // an absolute file replaces the root
  const auto end = std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first;
  if (failed || end != root.end() || path == root) throw InputError(where, file, "a file in the folder " + root.string());
  return path.string();
}

}  // namespace tissue_stiffness
