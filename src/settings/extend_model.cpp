#include "settings/extend_model.hpp"

#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Place = std::function<std::string(const std::string&)>;

// Places the files of all `file` keys, at any depth: that of the mesh, those of courses.
void place_files(YAML::Node node, const std::string& directory, const Place& place) {
  if (node.IsSequence()) {
    for (YAML::Node item : node) place_files(item, directory, place);
  }
  if (!node.IsMap()) return;
  for (auto entry : node) {
    if (entry.first.Scalar() == "file" && entry.second.IsScalar()) {
      entry.second = place((std::filesystem::absolute(directory) / entry.second.Scalar()).lexically_normal().string());
    } else {
      place_files(entry.second, directory, place);
    }
  }
}

}  // namespace

ModelSettings extend_model(ModelSettings model, const std::vector<EffectEntry>& entries) {
  for (const EffectEntry& entry : entries) add_effect(model, entry);
  return model;
}

ModelSettings extend_model(ModelSettings model, const std::vector<std::string>& entries) {
  for (const std::string& entry : entries) add_effect(model, entry);
  return model;
}

std::string extend_model(const std::string& text, const std::vector<std::string>& entries, const std::string& directory,
                         const Place& place) {
  try {
    YAML::Node model = YAML::Load(text);
    place_files(model, directory, place);
    for (const std::string& entry : entries) {
      YAML::Node effect = YAML::Load(entry);
      effect.begin()->second.SetStyle(YAML::EmitterStyle::Flow);
      model["effects"].push_back(effect);
    }
    YAML::Emitter out;
    out << model;
    return std::string(out.c_str()) + "\n";
  } catch (const YAML::Exception& error) {
    throw InputError("the model's text", error.what(), "a model file");
  }
}

}  // namespace tissue_stiffness
