#include "tools/gathered_files.hpp"

#include <filesystem>
#include <system_error>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "model_files";

void bring(const fs::path& from, const fs::path& to) {
  std::error_code failed;
  fs::create_directories(to.parent_path(), failed);
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, failed);
  if (failed)
    throw InputError(to.string(), "no copy of " + from.string() + ": " + failed.message(), "a folder to write to");
}

}  // namespace

std::string GatheredFiles::operator()(const std::string& path) {
  const fs::path from(path), folder = fs::weakly_canonical(folder_);
  const fs::path inside = fs::weakly_canonical(from).lexically_relative(folder);
  if (!inside.empty() && *inside.begin() != "..") return inside.generic_string();
  fs::path name = from.filename();
  const auto taken = [&] {
    const auto [known, is_new] = paths_.emplace(name.string(), path);
    return !is_new && known->second != path;
  };
  for (int k = 2; taken(); ++k) name = from.stem().string() + "_" + std::to_string(k) + from.extension().string();
  const fs::path to = folder / kFolder / name;
  bring(from, to);
  if (from.extension() == ".node") bring(fs::path(from).replace_extension(".ele"), fs::path(to).replace_extension(".ele"));
  return std::string(kFolder) + "/" + name.generic_string();
}

}  // namespace tissue_stiffness
