#include "effects/registry.hpp"
#include "report/text.hpp"
#include "report/write_results.hpp"
#include "tools/simulate_scene.hpp"

namespace tissue_stiffness {

void write_truth(const Scene& scene, const SimulationSummary& summary, const std::string& file) {
  std::string text = "parameters:\n";
  for (const EffectSettings& effect : scene.model.effects) {
    const std::vector<Quantity> values = read_parameters(effect);
    std::size_t k = 0;
    for (const ParameterSpec& spec : effect_spec(effect).parameters) {
      for (int c = 0; c < spec.components; ++c, ++k) {
        const std::string axis = spec.components > 1 ? std::string("_") + "xyz"[c] : "";
        text += "  " + effect.label + "." + spec.name + axis + ": " + exact_number(values[k].value) + "\n";
      }
    }
  }
  text += "frames: " + std::to_string(summary.frames) + "\n";
  text += "motion_rms: " + exact_number(summary.motion_rms) + "\n";
  text += "motion_max: " + exact_number(summary.motion_max) + "\n";
  write_text(file, text);
}

}  // namespace tissue_stiffness
