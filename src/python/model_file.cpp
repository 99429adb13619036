#include "python/model_file.hpp"

#include "settings/extend_model.hpp"
#include "settings/inside_folder.hpp"
#include "types/read_file.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::uintmax_t kLargestFile = 16000000;  // [byte]
constexpr char kOrElse[] = ", or allow_outside=True";

}  // namespace

ModelFile read_model_file(const std::string& file, bool allow_outside) {
  if (!allow_outside) require_files_inside(file, kOrElse);
  ModelSettings settings = load_model(file);
  return {std::move(settings), read_file(file, file, "a YAML file", kLargestFile), allow_outside};
}

ModelFile parse_model(const std::string& text, const std::string& directory, const std::string& name, bool allow_outside) {
  const Value root = parse_yaml(text, name);
  if (!allow_outside) require_files_inside(root, directory, kOrElse);
  return {read_model(root, directory), text, allow_outside};
}

ModelFile with_effects(const ModelFile& model, const std::vector<std::string>& entries) {
  const ModelSettings& settings = model.settings;
  return parse_model(extend_model(model.text, entries, settings.directory), settings.directory, settings.name,
                     model.allow_outside);
}

}  // namespace tissue_stiffness
