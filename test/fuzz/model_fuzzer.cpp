// A model file: YAML, its keys, and the numbers of its effects.
#include "effects/registry.hpp"
#include "fuzz_input.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tissue_stiffness;
  return fuzz_text(data, size, [](const std::string& text) {
    const ModelSettings settings = read_model(parse_yaml(text, "model.yaml"), ".");
    for (const EffectSettings& effect : settings.effects) read_parameters(effect);
  });
}
