// Every model file that the package ships can be read, effects and all.
#include <gtest/gtest.h>

#include <filesystem>

#include "effects/registry.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;

TEST(Config, EveryShippedModelIsValid) {
  int models = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TISSUE_STIFFNESS_SOURCE_DIR) / "config")) {
    // A scene is simulate's, not a model.
    if (entry.path().extension() != ".yaml" || entry.path().stem() == "scene") continue;
    SCOPED_TRACE(entry.path().string());
    ++models;
    ModelSettings model;
    ASSERT_NO_THROW(model = load_model(entry.path().string()));
    bool estimates = false;
    for (const EffectSettings& effect : model.effects) {
      std::vector<Quantity> parameters;
      EXPECT_NO_THROW(parameters = read_parameters(effect));
      for (const Quantity& parameter : parameters) estimates = estimates || parameter.estimated();
    }
    EXPECT_TRUE(estimates) << "nothing to estimate";
    if (model.mesh.source == MeshSettings::Source::file) {
      EXPECT_TRUE(fs::exists(model.mesh.file)) << model.mesh.file;
    }
  }
  EXPECT_GT(models, 0);
}

}  // namespace
}  // namespace tissue_stiffness
