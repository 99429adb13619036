#include "python/model_file.hpp"

#include "settings/extend_model.hpp"
#include "types/read_file.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::uintmax_t kLargestFile = 16000000;  // [byte]

}  // namespace

ModelFile read_model_file(const std::string& file) {
  ModelSettings settings = load_model(file);
  return {std::move(settings), read_file(file, file, "a YAML file", kLargestFile)};
}

ModelFile parse_model(const std::string& text, const std::string& directory, const std::string& name) {
  return {read_model(parse_yaml(text, name), directory), text};
}

ModelFile with_effects(const ModelFile& model, const std::vector<std::string>& entries) {
  const ModelSettings& settings = model.settings;
  return parse_model(extend_model(model.text, entries, settings.directory), settings.directory, settings.name);
}

}  // namespace tissue_stiffness
